// One fuzzer of libFuzzer: FMBPC_FUZZ_TARGET is a function of targets.hpp.
#include <cstddef>

#include "fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fpc::fuzz::FMBPC_FUZZ_TARGET(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
