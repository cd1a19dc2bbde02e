// Compiled for any processor, for those with AVX and FMA and for those with AVX-512; which of them
// runs is found out when the library is loaded. Sums may differ by rounding between machines, never
// on one.
#include "identification/cluster_lanes.hpp"

namespace fpc::clusters {
namespace {

/// The kernels for one kind of processor, TARGET, with vectors of V numbers.
#define FPC_KERNELS(NAME, TARGET, V)                                                              \
  struct NAME {                                                                                   \
    TARGET static void squaredNorms(const double* points, const double* center, const double* M,  \
                                    std::size_t n, double* squared) {                             \
      squaredNormsBy<V>(points, center, M, n, squared);                                           \
    }                                                                                             \
    TARGET static void approach(const double* points, const double* center, std::size_t n,        \
                                double* nearest) {                                                \
      approachBy<V>(points, center, n, nearest);                                                  \
    }                                                                                             \
    TARGET static double shareOut(const double* squared, std::size_t clusters, double* member,    \
                                  double* present) {                                              \
      return shareOutBy<V>(squared, clusters, member, present);                                   \
    }                                                                                             \
    TARGET static void scaleBlock(const double* points, const double* center, const double* root, \
                                  const double* squared, std::size_t n, double* scaled,           \
                                  double* offset, double* sums) {                                 \
      scaleBlockBy<V>(points, center, root, squared, n, scaled, offset, sums);                    \
    }                                                                                             \
    TARGET static void addScatter(const double* scaled, std::size_t n, double* scatter) {         \
      addScatterBy<V>(scaled, n, scatter);                                                        \
    }                                                                                             \
  }

template <class Own>
constexpr Kernels tableOf(const char* name) {
  return {name, Own::squaredNorms, Own::approach, Own::shareOut, Own::scaleBlock, Own::addScatter};
}

FPC_KERNELS(Any, , Two);
#if defined(__x86_64__) && defined(__GNUC__)
FPC_KERNELS(Fma, __attribute__((target("avx2,fma"))), Four);
FPC_KERNELS(Avx512, __attribute__((target("avx2,fma,avx512f,avx512dq,avx512vl"))), Eight);
#endif

}  // namespace

std::vector<Kernels> kernelsHere() {
  std::vector<Kernels> found{tableOf<Any>("any")};
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    found.push_back(tableOf<Fma>("fma"));
  if (__builtin_cpu_supports("fma") && __builtin_cpu_supports("avx512f") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    found.push_back(tableOf<Avx512>("avx512"));
#endif
  return found;
}

const Kernels& kernels() {
  static const Kernels fastest = kernelsHere().back();
  return fastest;
}

}  // namespace fpc::clusters
