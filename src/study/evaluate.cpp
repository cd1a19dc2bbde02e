#include "fmbpc/study/evaluate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr int kTanks = 5;
constexpr double kVolume[] = {1000.0, 1000.0, 1333.0, 1333.0, 1333.0};  // [m3]
constexpr double kLayerVolume = 600.0;
constexpr double kSample_h = 0.25;
constexpr double kXB = 0.08, kXP = 0.06, kInert = 0.08;  // nitrogen in biomass, in products; f_P
constexpr double kSolidsPerCod = 0.75;
const std::array<const char*, 13> kNames = {"S_I", "S_S",  "X_I",  "X_S",  "X_BH", "X_BA", "X_P",
                                            "S_O", "S_NO", "S_NH", "S_ND", "X_ND", "S_ALK"};
enum { kI, kS, kXi, kXs, kBH, kBA, kP, kO, kNO, kNH, kND, kXND, kALK };
using Water = std::array<double, 13>;

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
    return table_.values(row, found->second);
  }
  /// Inputs that a form of the plant may lack.
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
    const double KLa = at.record.orZero(numbered("KLa", t + 1), at.row);
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
  indices.percentile_95 = values[static_cast<std::size_t>(std::ceil(0.95 * n)) - 1];
  return indices;
}

/// Rows of the judged part, 15 minutes apart if the record is finer.
std::vector<Eigen::Index> judgedRows(const CsvTable& table, const EvaluateParams& params) {
  const Eigen::Index time = table.column("time");
  const Eigen::Index rows = table.rows();
  require(rows >= 3, table.file,
          "a record of three rows at least: a longer run, or an earlier report.record_from_h");
  const double start = table.values(0, time);
  const double sample = table.values(1, time) - start;
  const double end = table.values(rows - 1, time) - start;
  const double to = params.to_h < 0.0 ? end : params.to_h;
  const double from = params.from_h < 0.0 ? std::max(0.0, to - 168.0) : params.from_h;
  const double ratio = kSample_h / sample;
  const bool thin = ratio > 1.5 && std::abs(ratio - std::round(ratio)) < 1e-6;
  const auto stride = static_cast<Eigen::Index>(thin ? std::lround(ratio) : 1);
  const auto first = static_cast<Eigen::Index>(std::ceil(from / sample - 1e-6));
  std::vector<Eigen::Index> judged;
  for (Eigen::Index r = first; r < rows - 1; r += stride)
    if (table.values(r, time) - start < to - 1e-6) judged.push_back(r);
  require(judged.size() >= 2, table.file,
          "two rows or more in the judged part, --from-h to --to-h after the record's begin "
          "(report.record_from_h)");
  return judged;
}

}  // namespace

void EvaluateParams::validate() const {
  require(to_h < 0.0 || to_h > from_h, "to_h", "a time after from_h");
}

const LimitIndices& EffluentReport::limit(const std::string& name) const {
  for (const auto& entry : limits)
    if (entry.name == name) return entry;
  throw InputError("limit '" + name + "': expected one of TN, COD, NH, TSS, BOD");
}

EffluentReport evaluateEffluent(const CsvTable& table, const EvaluateParams& params) {
  params.validate();
  const Record record(table);
  const auto rows = judgedRows(table, params);
  const Eigen::Index time = table.column("time");
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
  report.days = n * (table.values(rows[1], time) - table.values(rows[0], time)) / 24.0;
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
