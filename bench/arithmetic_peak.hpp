// What a core can do at most: multiply-adds in registers that wait for nothing, as wide as the
// processor has them.
#pragma once

namespace fpc::bench {

template <int kNumbers>
struct Vectors {
  typedef double Lanes __attribute__((vector_size(8 * kNumbers)));  // NOLINT(modernize-use-using)
};

constexpr int kChains = 12;  // enough for the latency of two units

/// At least `work` multiply-adds of single numbers, by vectors of kNumbers.
template <int kNumbers>
__attribute__((always_inline)) inline double chains(double work) {
  using V = Vectors<kNumbers>;
  typename V::Lanes sums[kChains], factor{}, term{};
  factor += 0.5;
  term += 1.0;
  for (int i = 0; i < kChains; ++i) sums[i] = term * i;
  for (long n = static_cast<long>(work / (kChains * kNumbers)) + 1; n > 0; --n)
    for (int i = 0; i < kChains; ++i) sums[i] = sums[i] * factor + term;
  double total = 0.0;
  for (int i = 0; i < kChains; ++i) total += sums[i][0];
  return total;
}

#if defined(__x86_64__) && defined(__GNUC__)
__attribute__((target("fma"))) inline double chains256(double work) { return chains<4>(work); }
__attribute__((target("avx512f"))) inline double chains512(double work) { return chains<8>(work); }

/// Bits of the widest multiply-add there is; 128 where it is a multiplication and an addition.
inline int widestBits() {
  return __builtin_cpu_supports("avx512f") ? 512 : __builtin_cpu_supports("fma") ? 256 : 128;
}
/// At least `work` multiply-adds of single numbers, by vectors of so many bits.
inline double multiplyAdds(double work, int bits) {
  return bits == 512 ? chains512(work) : bits == 256 ? chains256(work) : chains<2>(work);
}
#else
inline int widestBits() { return 128; }
inline double multiplyAdds(double work, int /*bits*/) { return chains<2>(work); }
#endif

}  // namespace fpc::bench
