// A model with what was found of it.
#pragma once

#include <string>

#include "config/identified_file.hpp"

namespace fpc::python {

struct ModelHandle {
  IdentifiedModel identified;
  std::string report;  ///< JSON of the identification; empty: it was read
};

}  // namespace fpc::python
