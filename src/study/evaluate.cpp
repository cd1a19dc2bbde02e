#include "study/evaluate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "fmbpc/base/input_error.hpp"
#include "study/judged_rows.hpp"

namespace fpc {
namespace {

constexpr int kTanks = 5, kMixed = 2;                                   // the first two without air
constexpr double kVolume[] = {1000.0, 1000.0, 1333.0, 1333.0, 1333.0};  // [m3]
constexpr double kLayerVolume = 600.0;
constexpr double kXB = 0.08, kXP = 0.06, kInert = 0.08;  // nitrogen in biomass, in products; f_P
constexpr double kSolidsPerCod = 0.75;
const std::array<const char*, 13> kNames = {"S_I", "S_S",  "X_I",  "X_S",  "X_BH", "X_BA", "X_P",
                                            "S_O", "S_NO", "S_NH", "S_ND", "X_ND", "S_ALK"};
enum { kI, kS, kXi, kXs, kBH, kBA, kP, kO, kNO, kNH, kND, kXND, kALK };
using Water = std::array<double, 13>;

/// What the indices take a column for, by the beginning of its name; empty: nothing of theirs.
std::string unitOf(const std::string& name) {
  const auto begins = [&](const char* stem) { return name.rfind(stem, 0) == 0; };
  if (begins("S_ALK")) return "mol/m3";
  if (begins("S_") || begins("X_") || begins("TSS_L")) return "g/m3";
  if (begins("KLa")) return "1/d";
  return begins("Q") || begins("dose") ? "m3/d" : "";
}

bool sameUnit(const std::string& header, const std::string& unit) {
  return header.empty() || unit.empty() || header == unit ||
         (unit == "g/m3" && (header == "mg/l" || header == "mg/L"));
}

/// Columns of the record by name; what is measured has its true value beside it.
class Record {
 public:
  explicit Record(const CsvTable& table) : table_(table) {
    for (std::size_t c = 0; c < table.names.size(); ++c)
      places_[table.names[c]] = static_cast<Eigen::Index>(c);
  }
  bool has(const std::string& name) const { return places_.count(name) > 0; }
  double at(const std::string& name, Eigen::Index row) const {
    const auto truth = places_.find(name + "_true");
    const auto found = truth != places_.end() ? truth : places_.find(name);
    require(found != places_.end(), table_.file + ": column '" + name + "'",
            "a record of plant bsm1, bsm1_pi or bsm1_air");
    const auto column = static_cast<std::size_t>(found->second);
    const std::string& header = table_.units[column];
    require(sameUnit(header, unitOf(name)), table_.file + ": column '" + table_.names[column] + "'",
            "[" + unitOf(name) + "], got [" + header + "]");
    const double value = table_.values(row, found->second);
    require(std::isfinite(value), table_.at(row, found->second),
            "a number in the judged part (--from-h and --to-h leave rows out)");
    return value;
  }
  /// Carbon, which a form of the plant may lack.
  double orZero(const std::string& name, Eigen::Index row) const {
    return has(name) ? at(name, row) : 0.0;
  }

 private:
  const CsvTable& table_;
  std::map<std::string, Eigen::Index> places_;
};

std::string numbered(const std::string& stem, int number) { return stem + std::to_string(number); }

double solidsOf(const Water& w) {
  return kSolidsPerCod * (w[kXi] + w[kXs] + w[kBH] + w[kBA] + w[kP]);
}
double kjeldahl(const Water& w) {
  return w[kNH] + w[kND] + w[kXND] + kXB * (w[kBH] + w[kBA]) + kXP * (w[kP] + w[kXi]);
}
double codOf(const Water& w) { return w[kI] + w[kS] + w[kXi] + w[kXs] + w[kBH] + w[kBA] + w[kP]; }
double bodOf(const Water& w, double share) {
  return share * (w[kS] + w[kXs] + (1.0 - kInert) * (w[kBH] + w[kBA]));
}

Water tank(const Record& record, int number, Eigen::Index row) {
  Water w;
  for (std::size_t i = 0; i < kNames.size(); ++i)
    w[i] = record.at(numbered(kNames[i], number), row);
  return w;
}

/// Solubles of the settler's top; particulates of tank 5 in proportion to the suspended solids.
Water effluent(const Record& record, const Water& last, Eigen::Index row) {
  Water w = last;
  const double share = record.at("TSS_L1", row) / solidsOf(last);
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const bool soluble = kNames[i][0] == 'S';
    w[i] = soluble ? record.at(numbered(kNames[i] + std::string("_L"), 1), row) : w[i] * share;
  }
  return w;
}

/// Pollution units carried by a flow [kg/d].
double pollution(const Water& w, double tss, double bod_share, double flow, bool old) {
  const double nitrogen =
      old ? 20.0 * kjeldahl(w) + 20.0 * w[kNO] : 30.0 * kjeldahl(w) + 10.0 * w[kNO];
  return (2.0 * tss + codOf(w) + nitrogen + 2.0 * bodOf(w, bod_share)) * flow / 1000.0;
}

bool near(double value, double expected) { return std::abs(value - expected) <= 1e-6 * expected; }

/// What moved in the judged rows beyond what the benchmark leaves to a controller of class A.
Levers leversOf(const Record& record, const std::vector<Eigen::Index>& rows) {
  Levers levers = Levers::kClassA;
  for (const Eigen::Index row : rows) {
    bool sludge = !near(record.at("Qr", row), 18446.0) || !near(record.at("Qw", row), 385.0);
    bool blowers = false;
    for (int t = 1; t <= kTanks; ++t) {
      sludge = sludge || record.orZero(numbered("dose", t), row) > 1e-9;
      blowers = blowers || (t > kMixed && record.at(numbered("KLa", t), row) > 240.0 + 1e-6);
    }
    if (sludge) return Levers::kClassB;
    if (blowers) levers = Levers::kLargerBlowers;
  }
  return levers;
}

/// Sums over the judged rows.
struct Sums {
  std::array<std::vector<double>, 5> values;  // of the limited quantities
  std::vector<double> flow;
  double first_solids{}, last_solids{};
};

struct PlantRow {
  const Record& record;
  Eigen::Index row;
  double operator()(const std::string& name) const { return record.at(name, row); }
};

void addEnergy(const PlantRow& at, bool old, EffluentReport& report) {
  for (int t = 0; t < kTanks; ++t) {
    const double KLa = t < kMixed ? 0.0 : at(numbered("KLa", t + 1));
    report.AE += old ? 24.0 * kVolume[t] / 1333.0 * (0.0007 * KLa * KLa + 0.3267 * KLa)
                     : 8.0 / 1800.0 * kVolume[t] * KLa;
    if (KLa < 20.0) report.ME += 24.0 * 0.005 * kVolume[t];
    report.EC += 400.0 * at.record.orZero(numbered("dose", t + 1), at.row);
  }
  const double Qintr = at("Qintr"), Qr = at("Qr"), Qw = at("Qw");
  report.PE += old ? 0.04 * (Qintr + Qr + Qw) : 0.004 * Qintr + 0.008 * Qr + 0.05 * Qw;
}

void addSludge(const PlantRow& at, bool first, EffluentReport& report, Sums& sums) {
  report.SP += at("TSS_L10") * at("Qw") / 1000.0;
  double stored = 0.0;
  for (int t = 0; t < kTanks; ++t) stored += kVolume[t] * solidsOf(tank(at.record, t + 1, at.row));
  for (int i = 1; i <= 10; ++i) stored += kLayerVolume * at(numbered("TSS_L", i));
  sums.last_solids = stored / 1000.0;
  if (first) sums.first_solids = sums.last_solids;
}

void addWater(const PlantRow& at, bool old, EffluentReport& report, Sums& sums) {
  const Water out = effluent(at.record, tank(at.record, 5, at.row), at.row);
  Water in;
  for (std::size_t i = 0; i < kNames.size(); ++i) in[i] = at(std::string(kNames[i]) + "_in");
  const double Q_in = at("Q_in"), Q_e = Q_in - at("Qw"), tss = at("TSS_L1");
  report.EQI += pollution(out, tss, 0.25, Q_e, old);
  report.IQI += pollution(in, solidsOf(in), 0.65, Q_in, old);
  const double shown[] = {kjeldahl(out) + out[kNO], codOf(out), out[kNH], tss, bodOf(out, 0.25)};
  for (std::size_t i = 0; i < sums.values.size(); ++i) sums.values[i].push_back(shown[i]);
  sums.flow.push_back(Q_e);
}

/// As users of the benchmark have it (prctile): the sorted values stand in the middles of n equal
/// parts, joined by straight lines.
double percentile(const std::vector<double>& sorted, double share) {
  const auto n = static_cast<double>(sorted.size());
  const double place = std::clamp(share * n - 0.5, 0.0, n - 1.0);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

LimitIndices judge(const std::string& name, double limit, std::vector<double> values,
                   const std::vector<double>& flow) {
  LimitIndices indices{name, limit, 0.0, 0, 0.0, 0.0};
  double total = 0.0;
  int above = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    indices.mean += values[i] * flow[i];
    total += flow[i];
    if (!(values[i] > limit)) continue;
    ++above;
    if (i == 0 || !(values[i - 1] > limit)) ++indices.crossings;
  }
  const auto n = static_cast<double>(values.size());
  indices.mean /= total;
  indices.share_percent = 100.0 * above / n;
  std::sort(values.begin(), values.end());
  indices.percentile_95 = percentile(values, 0.95);
  return indices;
}

}  // namespace

void EvaluateParams::validate() const {
  require(to_h < 0.0 || to_h > from_h, "to_h", "a time after from_h");
}

std::string wordOf(Levers levers) {
  switch (levers) {
    case Levers::kClassA:
      return "A";
    case Levers::kLargerBlowers:
      return "A, KLa > 240";
    case Levers::kClassB:
      return "B";
  }
  return "";
}

const LimitIndices& EffluentReport::limit(const std::string& name) const {
  for (const auto& entry : limits)
    if (entry.name == name) return entry;
  throw InputError("limit '" + name + "': expected one of TN, COD, NH, TSS, BOD");
}

EffluentReport evaluateEffluent(const CsvTable& table, const EvaluateParams& params) {
  params.validate();
  const Record record(table);
  const JudgedRows judged = judgedRows(table, params);
  const auto& rows = judged.rows;
  EffluentReport report;
  Sums sums;
  for (const Eigen::Index row : rows) {
    const PlantRow at{record, row};
    addEnergy(at, params.weights_2002, report);
    addSludge(at, row == rows.front(), report, sums);
    addWater(at, params.weights_2002, report, sums);
  }
  const auto n = static_cast<double>(rows.size());
  report.samples = rows.size();
  report.sample_min = 60.0 * judged.spacing_h;
  report.days = n * judged.spacing_h / 24.0;
  report.levers = leversOf(record, rows);
  for (double* mean :
       {&report.EQI, &report.IQI, &report.AE, &report.PE, &report.ME, &report.SP, &report.EC})
    *mean /= n;
  report.SP += (sums.last_solids - sums.first_solids) / report.days;
  report.OCI = report.AE + report.PE + 5.0 * report.SP + 3.0 * report.EC + report.ME;
  const std::pair<const char*, double> limits[] = {
      {"TN", 18.0}, {"COD", 100.0}, {"NH", 4.0}, {"TSS", 30.0}, {"BOD", 10.0}};
  for (std::size_t i = 0; i < 5; ++i)
    report.limits.push_back(judge(limits[i].first, limits[i].second, sums.values[i], sums.flow));
  return report;
}

}  // namespace fpc
