// Messages <-> structs, field for field, bit for bit. fromMsg() refuses what no struct can mean;
// whether sizes fit the plant at hand is the core's question.
#pragma once

#include <fmbpc/CommandEffect.h>
#include <fmbpc/ControlAction.h>
#include <fmbpc/Disturbance.h>
#include <fmbpc/Event.h>
#include <fmbpc/FuzzyModel.h>
#include <fmbpc/Identified.h>
#include <fmbpc/Matrix.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/PlantInfo.h>
#include <fmbpc/PlantState.h>
#include <fmbpc/PredictiveAction.h>
#include <fmbpc/Setpoint.h>
#include <fmbpc/SignalInfo.h>
#include <fmbpc/SolverReport.h>
#include <fmbpc/Targets.h>
#include <fmbpc/Tracking.h>
#include <ros/time.h>

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/command_table.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "runtime/model_inbox.hpp"

namespace fpc {

/// Times before 0 s or after 2^32 s have no stamp. @throws InputError
ros::Time toStamp(std::int64_t time_ns);
std::int64_t fromStamp(const ros::Time& stamp);

fmbpc::Matrix toMsg(const Matrix& matrix);
fmbpc::SignalInfo toMsg(const SignalInfo& signal);
fmbpc::PlantInfo toMsg(const PlantInfo& info);
fmbpc::Measurement toMsg(const Measurement& measurement);
fmbpc::ControlAction toMsg(const ControlAction& action);
fmbpc::PredictiveAction toMsg(const PredictiveAction& action);
fmbpc::SolverReport toMsg(const SolverReport& report);
fmbpc::Targets toMsg(const Targets& targets);  ///< without events
fmbpc::Event toMsg(const Event& event);
std::vector<fmbpc::Event> toMsg(const std::vector<Event>& events);
fmbpc::Tracking toMsg(const Tracking& tracking);
fmbpc::PlantState toMsg(const PlantState& state);
fmbpc::CommandEffect toMsg(const CommandEffect& effect);
/// The answer to a command (stamp `asked`) that was refused.
fmbpc::CommandEffect refusalOf(const ros::Time& asked, const StepHeader& latest,
                               const std::string& why);
fmbpc::FuzzyModel toMsg(const TsModel& model);
/// The sample that a model was made from; run 0: none.
StepHeader headerOf(const fmbpc::FuzzyModel& msg);
fmbpc::FuzzyModel toMsg(const TsModel& model, const StepHeader& made_from);
fmbpc::Identified toMsg(const IdentifierWord& word);
IdentifierWord fromMsg(const fmbpc::Identified& msg);
fmbpc::Setpoint toSetpointMsg(const Command& command);
fmbpc::Disturbance toDisturbanceMsg(const Command& command);

/// All of these @throws InputError naming the field: a matrix whose data are not rows * cols, a
/// value that is not one of the message's constants, lists that belong together but differ in
/// length.
Matrix fromMsg(const fmbpc::Matrix& msg);
SignalInfo fromMsg(const fmbpc::SignalInfo& msg);
PlantInfo fromMsg(const fmbpc::PlantInfo& msg);
/// A value whose quality is not good becomes NaN, which says why (noValue).
Measurement fromMsg(const fmbpc::Measurement& msg);
ControlAction fromMsg(const fmbpc::ControlAction& msg);
PredictiveAction fromMsg(const fmbpc::PredictiveAction& msg);
SolverReport fromMsg(const fmbpc::SolverReport& msg);
Targets fromMsg(const fmbpc::Targets& msg);
/// A code that is not known is a note.
Event fromMsg(const fmbpc::Event& msg);
std::vector<Event> fromMsg(const std::vector<fmbpc::Event>& msg);
Tracking fromMsg(const fmbpc::Tracking& msg);
PlantState fromMsg(const fmbpc::PlantState& msg);
CommandEffect fromMsg(const fmbpc::CommandEffect& msg);
TsModel fromMsg(const fmbpc::FuzzyModel& msg);
Command fromMsg(const fmbpc::Setpoint& msg);
Command fromMsg(const fmbpc::Disturbance& msg);

}  // namespace fpc
