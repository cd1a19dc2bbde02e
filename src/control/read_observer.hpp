// Section `controller.observer` of the laws that estimate a disturbance.
#pragma once

#include "estimation/disturbance_observer.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {

/// How noisy the measurements are; defaults: those of `noise`. Returns whether an observer is to
/// take the place of raw differences: where there is noise, unless `observer: false`. `input_std`
/// is a key of laws that can place disturbances at the inputs, `estimated` one of laws whose
/// observer goes by a model. kAlways: there is no other way than the observer.
enum class ObserverKey { kNone, kInputStd, kEstimated, kAlways };
bool readObserver(YamlSection& controller, ObserverParams& params, const ControllerContext& loop,
                  ObserverKey key = ObserverKey::kNone);

}  // namespace fpc
