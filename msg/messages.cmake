# Messages, services and actions of the package.
add_message_files(DIRECTORY msg FILES
  CommandEffect.msg
  ControlAction.msg
  Disturbance.msg
  Event.msg
  FuzzyModel.msg
  FuzzyRegressor.msg
  FuzzyRule.msg
  FuzzySet.msg
  FuzzySubmodel.msg
  Identified.msg
  InputPlan.msg
  LoopState.msg
  Matrix.msg
  Measurement.msg
  NodeReady.msg
  OperatorState.msg
  PlantInfo.msg
  PlantState.msg
  PredictiveAction.msg
  Recorded.msg
  Setpoint.msg
  Signal.msg
  SignalInfo.msg
  SolverReport.msg
  Targets.msg
  Tracking.msg
)
add_service_files(DIRECTORY srv FILES Candidate.srv LoopOrder.srv ManualInput.srv)
add_action_files(DIRECTORY action FILES Commission.action IdentifyModel.action)
generate_messages(DEPENDENCIES actionlib_msgs std_msgs)
