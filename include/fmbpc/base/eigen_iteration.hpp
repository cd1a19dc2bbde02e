// Range-for over vectors with Eigen 3.3 (3.4 and newer have it): free begin and end, found by the
// vector's namespace.
#pragma once

#include <Eigen/Core>

#if !EIGEN_VERSION_AT_LEAST(3, 3, 90)
namespace Eigen {

/// First element of a vector whose elements lie side by side.
template <typename Derived>
auto begin(const DenseBase<Derived>& vector) {
  static_assert(Derived::InnerStrideAtCompileTime == 1 && Derived::IsVectorAtCompileTime,
                "range-for needs a contiguous vector");
  return vector.derived().data();
}
template <typename Derived>
auto begin(DenseBase<Derived>& vector) {
  static_assert(Derived::InnerStrideAtCompileTime == 1 && Derived::IsVectorAtCompileTime,
                "range-for needs a contiguous vector");
  return vector.derived().data();
}

/// Behind the last element.
template <typename Derived>
auto end(const DenseBase<Derived>& vector) {
  return begin(vector) + vector.size();
}
template <typename Derived>
auto end(DenseBase<Derived>& vector) {
  return begin(vector) + vector.size();
}

}  // namespace Eigen
#endif
