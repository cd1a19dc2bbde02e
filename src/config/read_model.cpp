// Section `model`: what the controller predicts with at the start, and how that may change on the
// way.
#include <utility>

#include "config/model_file.hpp"
#include "config/read.hpp"
#include "config/structure_file.hpp"
#include "fmbpc/base/option.hpp"

namespace fpc {
namespace {

void readOnline(YamlSection& identify, OnlineParams& params) {
  bool off = false;
  YamlSection section = identify.sectionOrOff("online", off);
  params.enabled = identify.has("online") && !off;
  section.integer("every", params.every, 1);
  section.number("forgetting", params.rls.forgetting, {0.0, 1.0, true});
  checked(section, [&] { params.validate(); });
  section.finish();
}

void readIdentify(YamlSection& model, LoopFile& loop) {
  YamlSection section = model.section("identify");
  IdentifyParams& params = loop.identify;
  loop.has_identify = model.has("identify");
  section.text("structure", params.structure_file);
  section.integer("after", params.after, 0);
  readOnline(section, params.online);
  if (params.after > 0 && params.structure_file.empty())
    section.fail("structure", "a structure file for identify.after");
  section.finish();
  if (params.structure_file.empty()) return;
  try {
    params.structure = readStructure(params.structure_file);
  } catch (const InputError& e) {
    throw InputError(section.where("structure") + ": " + e.what());
  }
}

bool suits(const TsModel& model, const LoopFile& loop) {
  try {
    matchToLoop(model, loop);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

void readModelSection(YamlSection& root, LoopFile& loop) {
  YamlSection section = root.section("model");
  section.text("file", loop.model_file);
  bool instruments_missing = false;
  readOption(section, "instruments", instruments_missing, {{"included", false}, {"added", true}});
  section.number("max_pole", loop.max_pole, {0.0, kInfinity, true});
  readIdentify(section, loop);
  section.finish();
  loop.has_model = !loop.model_file.empty();
  const ControllerType& controller = loop.controllerType();
  if (controller.needs_model && !loop.has_model && !(loop.has_identify && loop.external_plant))
    section.fail("file", "a model file for controller " + controller.name +
                             " (a simulated plant does not start without one)");
  if (loop.has_identify && !loop.controller->signalUse(controllerContext(loop)).estimated.empty())
    section.fail("identify",
                 "no such section beside controller.observer.estimated: no record of "
                 "this loop knows what nobody measures");
  if (!loop.has_model) return;
  try {
    loop.model = readModel(loop.model_file);
    if (!controller.needs_model && !loop.has_identify && !suits(loop.model, loop)) {
      loop.has_model = false;  // inherited, and of no use to this controller
      return;
    }
    loop.model = matchToLoop(loop.model, loop);
    if (instruments_missing) loop.model = withInstruments(std::move(loop.model), loop.simulation);
    loop.controller->checkModel(loop.model, controllerContext(loop));
    if (loop.fallback) loop.fallback->checkModel(loop.model, controllerContext(loop));
  } catch (const InputError& e) {
    throw InputError(section.where("file") + ": " + e.what());
  }
}

}  // namespace fpc
