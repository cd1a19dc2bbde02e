// BSM1, the benchmark plant of wastewater control: five tanks with activated sludge model no. 1 and
// a settler of ten layers, 145 states; as `bsm1_pi` and `bsm1_air` with the benchmark's default
// control in continuous time inside, so that a slow controller moves setpoints.
//
//   influent ->[1]->[2]->[3]->[4]->[5]-> settler -> effluent       1, 2 stirred; 3, 4, 5 aerated
//               ^     Q_intr       |       |
//               |------------------|       |-> Q_w
//               |--------- Q_r ------------|
//
// Source: J. B. Copp (ed.), The COST simulation benchmark (2002); J. Alex et al., Benchmark
// Simulation Model no. 1 (2008). The volume of the dosed carbon is neglected.
#include <algorithm>

#include "plant/bsm1/description.hpp"
#include "plant/bsm1/stepper.hpp"
#include "plant/state_range.hpp"

namespace fpc::bsm1 {
namespace {

class Bsm1 final : public Plant {
 public:
  Bsm1(Front front, const PlantParameters& parameters)
      : front_(front),
        description_(describe(front)),
        parameters_(readParameters(front, description_, parameters)) {}
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override;
  std::unique_ptr<PlantStepper> makeStepper(double sample_time_s) const override;

  bool hasLoops() const { return front_ != Front::kValves; }
  const Parameters& parameters() const { return parameters_; }
  Drive driveOf(VectorRef u, VectorRef d) const;
  WorksState stateOf(VectorRef x) const;
  void write(const WorksState& state, Eigen::Ref<Vector> x) const;

 private:
  void readFront(VectorRef u, Drive& drive) const;

  Front front_;
  PlantDescription description_;
  Parameters parameters_;
};

WorksState Bsm1::stateOf(VectorRef x) const {
  WorksState state;
  unpack(x.data(), state.z, state.settler);
  if (hasLoops()) std::copy_n(x.data() + kStates, kLoopStates, state.loops.begin());
  return state;
}

void Bsm1::write(const WorksState& state, Eigen::Ref<Vector> x) const {
  pack(state.z, state.settler, x.data());
  if (hasLoops()) std::copy_n(state.loops.begin(), kLoopStates, x.data() + kStates);
}

void Bsm1::readFront(VectorRef u, Drive& drive) const {
  if (front_ == Front::kValves) {
    for (int i = 0; i < kAerated; ++i)
      drive.in.KLa[kFirstAerated + i] =
          std::min(u[i], drive.capacity * description_.inputs[static_cast<std::size_t>(i)].upper);
    drive.in.Q_intr = u[kAerated];
  } else if (front_ == Front::kSetpoints) {
    for (int i = 0; i < kAerated; ++i) drive.setpoints.S_O[i] = u[i];
    drive.setpoints.S_NO = u[kAerated];
  } else {
    for (int i = 0; i < kAerated; ++i) {
      const AirLine& line = parameters_.air[i];
      drive.setpoints.S_O[i] =
          std::min(std::max(line.offset + line.slope * u[0], line.lower), line.upper);
    }
    const NitrateLean& lean = parameters_.nitrate_lean;
    drive.setpoints.S_NO = std::max(u[1] + lean.slope * (drive.setpoints.S_O[1] - lean.about), 0.0);
  }
}

Drive Bsm1::driveOf(VectorRef u, VectorRef d) const {
  Drive drive;
  std::copy_n(d.data(), kComponents, drive.in.influent.begin());
  drive.in.Q_in = d[kComponents];
  drive.capacity = d[kComponents + 1];
  readFront(u, drive);
  const Eigen::Index first = u.size() - kTanks - 2;
  drive.in.Q_r = u[first];
  drive.in.Q_w = u[first + 1];
  for (int t = 0; t < kTanks; ++t) drive.in.dose[t] = u[first + 2 + t];
  return drive;
}

void Bsm1::derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const {
  const WorksState state = stateOf(x);
  Drive drive = driveOf(u, d);
  WorksState rate;
  if (hasLoops())
    localLoops(parameters_.loops, drive.setpoints, {}, drive.capacity, state.z, state.loops,
               drive.in, rate.loops);
  reactors(parameters_.works, drive.in, state.z, state.settler, rate.z);
  settle(parameters_.works.settler, settlerFlows(drive.in), state.settler,
         solids(parameters_.works, state.z, kTanks - 1), feedSolubles(state.z), rate.settler);
  write(rate, dxdt);
}

/// A state outside its range by more than this [its unit] is no rounding of a step.
constexpr double kTolerance = 1e-3;
/// In ASM1 heterotrophs take the nitrogen of their growth from ammonium even where none is left
/// (alex2008, process 1): in thin water it falls below 0, by no fault of the steps [g/m3].
constexpr double kAmmoniumDebt = 10.0;

std::vector<Quantity> reachableStates(const Plant& plant) {
  std::vector<Quantity> states = plant.description().states;
  for (Quantity& state : states)
    if (state.name.rfind("S_NH", 0) == 0) state.lower = -kAmmoniumDebt;
  return states;
}

class Bsm1Stepper final : public PlantStepper {
 public:
  Bsm1Stepper(const Bsm1& plant, double sample_time_s)
      : plant_(plant),
        reachable_(reachableStates(plant)),
        days_(sample_time_s / plant.description().time_unit_s),
        stepper_(plant.parameters().works, plant.hasLoops() ? &plant.parameters().loops : nullptr,
                 static_cast<std::uint64_t>(plant.parameters().noise_seed)) {}
  void reset(VectorRef, VectorRef) override { stepper_.reset(); }
  void advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d) override {
    WorksState state = plant_.stateOf(x);
    stepper_.advance(state, plant_.driveOf(u, d), days_);
    plant_.write(state, x);
    failure_ = outsideRange(reachable_, kStates, x, kTolerance);
    if (!failure_.empty()) failure_ += ": something is too fast for the plant's steps of 8.64 s";
  }
  std::string failure() const override { return failure_; }
  bool remembers() const override { return plant_.parameters().loops.noise > 0.0; }

 private:
  const Bsm1& plant_;
  std::vector<Quantity> reachable_;
  double days_;
  WorksStepper stepper_;
  std::string failure_;
};

std::unique_ptr<PlantStepper> Bsm1::makeStepper(double sample_time_s) const {
  return std::make_unique<Bsm1Stepper>(*this, sample_time_s);
}

bool enlist(Front front) {
  return registerPlant(describe(front).name, [front](const PlantParameters& parameters) {
    return std::make_unique<Bsm1>(front, parameters);
  });
}

const bool kBsm1Registered =
    enlist(Front::kValves) && enlist(Front::kSetpoints) && enlist(Front::kAir);

}  // namespace
}  // namespace fpc::bsm1
