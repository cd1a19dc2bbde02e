#include "ros/identify_messages.hpp"

#include <algorithm>

#include "config/model_file.hpp"

namespace fpc {

fmbpc::IdentifyModelFeedback toFeedback(const RecordProgress& progress) {
  const IdentifyProgress& now = progress.identify;
  fmbpc::IdentifyModelFeedback msg;
  msg.stage = now.stage;
  msg.output = now.output;
  msg.samples = static_cast<std::uint32_t>(now.samples);
  msg.iteration = static_cast<std::uint32_t>(std::max(now.iteration, 0));
  msg.objective = now.objective;
  msg.share = now.share;
  for (const OutputValidation& output : progress.validation) {
    msg.validated.push_back(output.output);
    msg.one_step_vaf.push_back(output.one_step.vaf);
    msg.free_run_vaf.push_back(output.free_run.vaf);
  }
  return msg;
}

fmbpc::IdentifyModelResult toResult(const RecordIdentification& identification) {
  const TsModel& model = identification.found.model;
  fmbpc::IdentifyModelResult msg;
  msg.model = model.name;
  msg.model_text = writeModel(model);
  msg.rows = static_cast<std::uint32_t>(identification.rows);
  msg.held_out = static_cast<std::uint8_t>(identification.held_out);
  for (const OutputValidation& output : identification.validation) {
    msg.outputs.push_back(output.output);
    msg.one_step_vaf.push_back(output.one_step.vaf);
    msg.free_run_vaf.push_back(output.free_run.vaf);
    msg.linear_one_step_vaf.push_back(output.linear_one_step.vaf);
    msg.linear_free_run_vaf.push_back(output.linear_free_run.vaf);
  }
  msg.remarks = identification.found.remarks;
  for (const RuleRemark& remark : reportModel(model))
    msg.remarks.push_back(remark.output + " rule " + std::to_string(remark.rule) + ": " +
                          remark.text);
  return msg;
}

}  // namespace fpc
