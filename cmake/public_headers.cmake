# The headers that are installed: what a package with a plant or a controller of its own includes, and what those include in turn.
# test/public_headers_test.py holds the list to what docs/ and examples/ name.
set(FMBPC_PUBLIC_HEADERS
  base/command_table.hpp
  base/eigen_iteration.hpp
  base/input_error.hpp
  base/input_limits.hpp
  base/layout.hpp
  base/option.hpp
  base/ring.hpp
  base/sample_clock.hpp
  base/signals.hpp
  base/state_space.hpp
  base/text.hpp
  base/types.hpp
  base/yaml_section.hpp
  control/bumpless_transfer.hpp
  control/controller.hpp
  control/plan_view.hpp
  control/predictive_law.hpp
  control/reference.hpp
  control/registry.hpp
  control/setpoint_source.hpp
  control/settings.hpp
  control/settings_table.hpp
  fuzzy/domain.hpp
  fuzzy/local_model.hpp
  fuzzy/membership.hpp
  fuzzy/model_match.hpp
  fuzzy/multivariate_membership.hpp
  fuzzy/ts_model.hpp
  plant/plant.hpp)
foreach(header ${FMBPC_PUBLIC_HEADERS})
  get_filename_component(room ${header} DIRECTORY)
  install(FILES include/fmbpc/${header} DESTINATION ${FMBPC_INCLUDE}/${room})
endforeach()
