// What the library fmbpc_design_core does for loops. The core loads it when one of these is first
// asked for, so that a loop that neither identifies nor is commissioned needs no such library.
#pragma once

#include <memory>
#include <string>

#include "identification/identified_model.hpp"
#include "identification/record_identification.hpp"

namespace fpc {

class StagesJob;
struct StagesWish;

struct DesignLibrary {
  RecordIdentification (*identify_record)(const Matrix& values, Structure structure,
                                          const std::string& source, double share,
                                          const RecordCallback& callback);
  IdentifiedModel (*read_identified)(const std::string& file);
  std::unique_ptr<StagesJob> (*stages)(const StagesWish& wish);
};

/// @throws InputError if the library is not built yet; `what` asks for it.
const DesignLibrary& designLibrary(const std::string& what);

}  // namespace fpc
