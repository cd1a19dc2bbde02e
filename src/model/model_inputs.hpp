// Which inputs a model knows.
#pragma once

namespace fpc {

struct TsModel;

/// False for an input that no rule has as a regressor: nobody who goes by the model moves it.
bool knowsInput(const TsModel& model, int input);

}  // namespace fpc
