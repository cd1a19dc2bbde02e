// What a fuzzer's bytes decide, one after the other; past their end every decision is the first.
#pragma once

#include <string>

#include "fmbpc/base/types.hpp"

namespace fpc::fuzz {

class Bytes {
 public:
  explicit Bytes(const std::string& bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}
  int next() { return at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_++]) : 0; }
  int below(int n) { return next() % n; }
  bool empty() const { return at_ >= bytes_.size(); }
  /// Few and odd values: ties, zeros, rounding and the ends of the range come up by themselves.
  double number() {
    static const double odd[] = {0.0,  1.0, -1.0, 0.5,  2.0,   -3.0,      1e-16,      -2.8e-17,
                                 1e-9, 1e6, -1e6, 1e12, 1e-12, kInfinity, -kInfinity, 100.0};
    const int byte = next();
    return byte < 128 ? odd[byte % 16] : (byte - 192) / 16.0;
  }

 private:
  const std::string& bytes_;
  std::size_t at_;
};

}  // namespace fpc::fuzz
