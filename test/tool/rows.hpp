// Rows for tests, as papers/KEY.yaml would give them.
#pragma once

#include <string>

#include "papers/experiment.hpp"

namespace fpc::papers {

inline Row figure(const std::string& quantity, double paper, Values here, const std::string& unit) {
  Row row;
  row.quantity = quantity;
  row.paper = paper;
  row.here = std::move(here);
  row.unit = unit;
  return row;
}

inline Row check(const std::string& quantity, Values here, Direction side, double limit,
                 const std::string& unit, const std::string& note) {
  Row row = figure(quantity, limit, std::move(here), unit);
  row.statement = true;
  row.direction = side;
  row.note = note;
  return row;
}

inline Row incomparable(const std::string& quantity, double paper, Values here,
                        const std::string& unit, const std::string& reason) {
  Row row = figure(quantity, paper, std::move(here), unit);
  row.incomparable = reason;
  return row;
}

}  // namespace fpc::papers
