// Search without derivatives inside a box, a generation at a time: one interface for swarms,
// random search, differential evolution and CMA-ES. The caller judges the points, in any order and
// on any number of threads; the same seed and the same costs give the same points.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

class PopulationSearch {
 public:
  virtual ~PopulationSearch() = default;
  /// The next generation, n x population, one column a point, inside the box. No columns: the
  /// method has nothing left to ask.
  virtual Matrix ask() = 0;
  /// The costs of the columns just asked. NaN counts as infinite.
  virtual void tell(const Vector& costs) = 0;
};

/// Particle swarms (apso: with an inertia that adapts), uniform points, differential evolution,
/// CMA-ES.
enum class SearchMethod { kApso, kPso, kRandom, kDe, kCmaes };
inline std::vector<std::string> wordsOf(SearchMethod) {
  return {"apso", "pso", "random", "de", "cmaes"};
}

/// What to search with. Symbols: w inertia, C1 and C2 pulls to the own and the common best.
struct SearchParams {
  SearchMethod method{SearchMethod::kApso};
  int population{10};
  int evaluations{300};  ///< of the cost, in all, exactly; the first generation counts
  std::uint64_t seed{1};
  double cognitive{1.5}, social{2.5};           ///< swarms: C1, C2
  double speed_upper{0.2};                      ///< swarms: of each range, per generation
  double inertia{1.4};                          ///< apso: w0
  double inertia_start{0.9}, inertia_end{0.4};  ///< pso: w, falling linearly
  double differential_weight{0.8};              ///< de: F
  double crossover{0.9};                        ///< de: CR
  int variant{2};                               ///< de: 1 best/1/exp, 2 rand/1/exp, ... of pagmo
  double step{0.3};                             ///< cmaes: sigma0, of each range
  /// @throws InputError naming the field, also of a method that this build has not.
  void validate() const;
};

/// apso, pso, random; and de, cmaes where pagmo2 was there at build time.
std::vector<std::string> searchMethods();
/// @throws InputError naming search.method and what this build has.
SearchMethod searchMethod(const std::string& word);
/// Why a known method is not in searchMethods(), in words.
std::string missingMethods();

/// `start`, if not empty, is the first point asked. All methods begin with the same generation for
/// the same seed. @throws InputError: params, bounds not finite or of different sizes, lower >
/// upper.
std::unique_ptr<PopulationSearch> makeSearch(const SearchParams& params, const Vector& lower,
                                             const Vector& upper, const Vector& start = {});

struct SearchResult {
  Vector best;
  double cost{};  ///< infinite if no point had a finite cost
  int evaluations{};
  int generations{};
  bool stopped{false};  ///< by the judge
};

/// Judges the columns: false stops the search, the columns are then not counted.
using Judge = std::function<bool(const Matrix& points, Vector& costs)>;

/// Asks, judges and tells until exactly params.evaluations points are judged (the last generation
/// is cut), the judge stops or the method ends. Of equal costs the first point is the best.
SearchResult runSearch(const SearchParams& params, const Vector& lower, const Vector& upper,
                       const Judge& judge, const Vector& start = {});

}  // namespace fpc
