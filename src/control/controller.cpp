#include "fmbpc/control/controller.hpp"

namespace fpc {

Settings Controller::settings() const { return {}; }

bool Controller::retune(const Settings& /*settings*/) { return false; }

bool Controller::adapt(bool /*on*/) { return false; }

void Controller::lookOn(const Measurement& /*now*/) {}

bool Controller::foresee(const Measurement& /*now*/, Eigen::Ref<Vector> /*outputs*/) {
  return false;
}

bool Controller::expect(std::uint32_t /*k*/, Eigen::Index /*disturbance*/, VectorRef /*ahead*/) {
  return false;
}

void Controller::setModel(const TsModel& /*model*/) {}

bool Controller::mayBeSent(VectorRef /*input*/) const { return true; }

void Controller::makeSendable(Eigen::Ref<Vector> /*input*/) const {}

const std::vector<std::pair<std::string, double>>& Controller::signals() const {
  static const std::vector<std::pair<std::string, double>> none;
  return none;
}

}  // namespace fpc
