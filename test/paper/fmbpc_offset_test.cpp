// Freedom from offset on the real plant with the paper's model: x_ref 1900 mg/l at two constant
// loads, q_r within 0..1600 m3/h; |x - x_ref| at 166 h must be at most 0.5 mg/l.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "control/fmbpc/law_fixture.hpp"
#include "paper/paper_plant.hpp"

namespace fpc {
namespace paper_fmbpc_offset_test {

double finalOffset(const FmbpcParams& params, const Vector& constant_loads) {
  const SimulationParams simulation = test::paperPlant(constant_loads, 1600.0);
  Simulation plant(simulation);
  FmbpcLaw law(params, simulation.actuator.limits, plant.info());
  law.setModel(test::shippedModel("fm_1"));
  SetpointSource setpoint = test::setpointOf(plant.info(), test::pair(55.0, 1900.0));
  Measurement now = plant.reset(1);
  law.reset(now);
  ControllerOutput output;
  for (std::uint32_t k = 0; k < test::kPaperSamples; ++k) {
    setpoint.advance(k);
    law.step(now, setpoint, output);
    EXPECT_TRUE(output.ok);
    now = plant.advance(output.input);
  }
  return now.outputs[1] - 1900.0;
}

TEST(Fm1, BiomassEndsWithinHalfAMilligramOfItsSetpoint) {
  for (const FmbpcRealisation realisation :
       {FmbpcRealisation::kParallel, FmbpcRealisation::kRealigned})
    for (const Vector& constant_loads : {test::loads(1300.0, 366.67), test::loads(1500.0, 400.0)}) {
      FmbpcParams params = test::publishedParams();
      params.realisation = realisation;
      const double offset = finalOffset(params, constant_loads);
      EXPECT_LE(std::abs(offset), 0.5) << wordOf(realisation) << ", q_i " << constant_loads[0];
      std::printf("%s, q_i %.0f: offset of x %.3f mg/l\n", wordOf(realisation).c_str(),
                  constant_loads[0], offset);
    }
}

}  // namespace paper_fmbpc_offset_test
}  // namespace fpc
