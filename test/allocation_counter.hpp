// Counts heap allocations of the calling thread: malloc, calloc, realloc, aligned allocation and
// operator new (which reaches malloc in libstdc++). For tests of code that must not allocate. It
// replaces the C library's functions, so include it in exactly one source file of a test
// executable. Under a sanitizer, which owns malloc, it counts nothing: ask
// AllocationCounter::works().
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__has_feature)  // clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FMBPC_ALLOCATION_COUNTER_WORKS 0
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // gcc
#define FMBPC_ALLOCATION_COUNTER_WORKS 0
#endif
#ifndef FMBPC_ALLOCATION_COUNTER_WORKS
#define FMBPC_ALLOCATION_COUNTER_WORKS 1
#endif

namespace fpc::testing {

inline thread_local std::size_t allocations_of_thread = 0;

/// Allocations of this thread since construction or reset(). Freeing is not counted.
class AllocationCounter {
 public:
  static constexpr bool works() { return FMBPC_ALLOCATION_COUNTER_WORKS != 0; }
  std::size_t count() const { return allocations_of_thread - start_; }
  void reset() { start_ = allocations_of_thread; }

 private:
  std::size_t start_{allocations_of_thread};
};

}  // namespace fpc::testing

#if FMBPC_ALLOCATION_COUNTER_WORKS
// glibc's own names of the functions: dlsym(RTLD_NEXT, ...) would itself allocate.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++fpc::testing::allocations_of_thread;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  ++fpc::testing::allocations_of_thread;
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  ++fpc::testing::allocations_of_thread;
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++fpc::testing::allocations_of_thread;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++fpc::testing::allocations_of_thread;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  ++fpc::testing::allocations_of_thread;
  void* result = __libc_memalign(alignment, size);
  if (result == nullptr) return ENOMEM;
  *block = result;
  return 0;
}
}
#endif
