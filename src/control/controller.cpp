#include "fmbpc/control/controller.hpp"

namespace fpc {

void Controller::setModel(const TsModel& /*model*/) {}

const std::vector<std::pair<std::string, double>>& Controller::signals() const {
  static const std::vector<std::pair<std::string, double>> none;
  return none;
}

}  // namespace fpc
