// Names of topics, services and parameters: short, relative, in one place. Namespaces come from
// launch files.
#pragma once

namespace fpc::topics {

inline constexpr char kPlantInfo[] = "plant_info";
inline constexpr char kMeasurement[] = "measurement";
inline constexpr char kPlantState[] = "plant_state";
inline constexpr char kBaseAction[] = "base_action";
inline constexpr char kControlAction[] = "control_action";
inline constexpr char kPredictiveAction[] = "predictive_action";
inline constexpr char kSolverReport[] = "solver_report";
inline constexpr char kInputPlan[] = "input_plan";
inline constexpr char kTracking[] = "tracking";
inline constexpr char kTargets[] = "targets";
inline constexpr char kFuzzyModel[] = "fuzzy_model";
inline constexpr char kIdentified[] = "identified";
inline constexpr char kSetpoint[] = "setpoint";
inline constexpr char kSetpointActive[] = "setpoint_active";
inline constexpr char kSetpointEffect[] = "setpoint_effect";
inline constexpr char kDisturbance[] = "disturbance";
inline constexpr char kDisturbanceEffect[] = "disturbance_effect";
inline constexpr char kRecorded[] = "recorded";
inline constexpr char kSampleRecorded[] = "sample_recorded";
inline constexpr char kReady[] = "ready";
inline constexpr char kRunEnd[] = "run_end";
inline constexpr char kLoopState[] = "loop_state";
inline constexpr char kOperatorState[] = "operator_state";
inline constexpr char kOperatorKept[] = "operator_kept";
inline constexpr char kModelKept[] = "model_kept";
inline constexpr char kSignalPrefix[] = "signal/";
inline constexpr char kClock[] = "/clock";

// Keys of loop.publishers that are no topics: gateway.enable_topic, private services.
inline constexpr char kEnable[] = "enable";
inline constexpr char kTags[] = "tags";
inline constexpr char kServices[] = "services";

// Private actions.
inline constexpr char kIdentify[] = "identify";
inline constexpr char kCommission[] = "commission";

// Private services.
inline constexpr char kPause[] = "pause";
inline constexpr char kStep[] = "step";
inline constexpr char kReset[] = "reset";
inline constexpr char kManual[] = "manual";
inline constexpr char kAdapt[] = "adapt";
inline constexpr char kManualInput[] = "manual_input";
inline constexpr char kHold[] = "hold";
inline constexpr char kCandidate[] = "candidate";
inline constexpr char kSettings[] = "settings";

// Parameters: the loop as text (`fmbpc resolve`), searched upwards from the node's namespace.
inline constexpr char kLoopText[] = "loop_text";
inline constexpr char kLoopName[] = "loop_name";

}  // namespace fpc::topics
