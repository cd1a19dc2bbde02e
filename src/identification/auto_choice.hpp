// From judgements to models: which kinds are worth it, fitted once more to the whole record.
#pragma once

#include "identification/auto_search.hpp"

namespace fpc {

/// Up to so many of the best judgements whose averaged free runs are best on the held-out blocks.
struct Committee {
  std::vector<const Judgement*> members;
  Vector free_run, one_step;  ///< held out
  Vector correction;
};
Committee chooseCommittee(const AutoData& data, const StructureSearch& found);

/// Figures of held-out predictions. `confirmed`: by choices that did not look at the block, see
/// confirmChoices(); empty: free_run, where nothing was chosen.
AutoFigures figuresOf(const AutoData& data, const Vector& free_run, const Vector& one_step,
                      const Vector& confirmed = {});

/// Half of each, where both say something (NaN: nobody). Equal weights need no rows to be found
/// from.
Vector meanOf(const Vector& one, const Vector& other);

/// Fits a candidate to all rows; from other seeds where that fails by the measure of its held-out
/// error; to the rows of the search where all fits to more run away under larger inputs. Not
/// finite: none came within `most` times that error.
Fitted fitWhole(const AutoData& data, const Judgement& judged, int window, double most = 2.0);

/// Of several starts of one structure, those that got stuck in the fit to all rows become not
/// finite.
void dropStuck(const Committee& committee, std::vector<Fitted>& fitted);

/// The confirmed mean of the blocks' errors is lower by 3 %.
bool isLower(const AutoFigures& other, const AutoFigures& than);
/// The same, and beyond the spread.
bool isWorthIt(const AutoFigures& other, const AutoFigures& linear);

/// `other` is better than `linear` by more than the spread of their ratio over parts of the blocks.
bool beyondSpread(const AutoFigures& other, const AutoFigures& linear);

}  // namespace fpc
