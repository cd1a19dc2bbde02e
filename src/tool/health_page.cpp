#include "tool/health_page.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/files.hpp"
#include "base/finite_json.hpp"
#include "fmbpc/base/text.hpp"
#include "supervision/health/finite_runs.hpp"

namespace fpc::tool {
namespace {

constexpr double kPageWidth = 860.0, kPictureHeight = 200.0, kPictureLeft = 70.0,
                 kPictureBottom = 24.0, kPictureTop = 20.0;
constexpr std::size_t kPictureColumns = 780;  // of a picture

std::string htmlText(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

struct PageCurve {
  std::string name, colour;
  std::vector<double> x, y;
};

/// Least and largest value of each column of the picture, so that no peak is lost.
PageCurve trendOf(const std::string& name, const std::string& colour,
                  const std::vector<double>& values, double step, double from = 0.0) {
  PageCurve curve{name, colour, {}, {}};
  const std::size_t block = 1 + values.size() / kPictureColumns;
  for (std::size_t k = 0; k < values.size(); k += block) {
    double low = kInfinity, high = -kInfinity;
    for (std::size_t j = k; j < std::min(k + block, values.size()); ++j) {
      if (!std::isfinite(values[j])) continue;
      low = std::min(low, values[j]);
      high = std::max(high, values[j]);
    }
    const double at = from + step * static_cast<double>(k);
    const bool some = low <= high;
    curve.x.push_back(at);
    curve.y.push_back(some ? low : kNaN);
    if (block == 1) continue;
    curve.x.push_back(at);
    curve.y.push_back(some ? high : kNaN);
  }
  return curve;
}

std::string picture(const std::string& title, const std::string& axis,
                    const std::vector<PageCurve>& curves) {
  double x0 = kInfinity, x1 = -kInfinity, y0 = kInfinity, y1 = -kInfinity;
  for (const PageCurve& c : curves)
    for (std::size_t k = 0; k < c.x.size(); ++k) {
      if (!std::isfinite(c.y[k])) continue;
      x0 = std::min(x0, c.x[k]);
      x1 = std::max(x1, c.x[k]);
      y0 = std::min(y0, c.y[k]);
      y1 = std::max(y1, c.y[k]);
    }
  if (!(x1 > x0)) return "";
  if (!(y1 > y0)) y1 = y0 + std::max(1e-9, 0.01 * std::abs(y0));
  const auto px = [&](double x) {
    return kPictureLeft + (x - x0) / (x1 - x0) * (kPageWidth - kPictureLeft - 10.0);
  };
  const auto py = [&](double y) {
    return kPictureTop + (y1 - y) / (y1 - y0) * (kPictureHeight - kPictureTop - kPictureBottom);
  };
  std::ostringstream svg;
  svg << "<svg viewBox=\"0 0 " << kPageWidth << " " << kPictureHeight << "\" role=\"img\"><title>"
      << htmlText(title) << "</title>\n<text x=\"" << kPictureLeft << "\" y=\"13\">"
      << htmlText(title);
  for (const PageCurve& c : curves)
    svg << " <tspan fill=\"" << c.colour << "\">&#9632; " << htmlText(c.name) << "</tspan>";
  svg << "</text>\n<rect x=\"" << kPictureLeft << "\" y=\"" << kPictureTop << "\" width=\""
      << kPageWidth - kPictureLeft - 10.0 << "\" height=\""
      << kPictureHeight - kPictureTop - kPictureBottom << "\" fill=\"none\" stroke=\"#bbb\"/>\n";
  for (const double share : {0.0, 0.5, 1.0}) {
    const double y = y0 + share * (y1 - y0), x = x0 + share * (x1 - x0);
    svg << "<text x=\"" << kPictureLeft - 4.0 << "\" y=\"" << py(y) + 4.0
        << "\" text-anchor=\"end\">" << shortText(y) << "</text><text x=\"" << px(x) << "\" y=\""
        << kPictureHeight - 8.0 << "\" text-anchor=\""
        << (share == 0.0   ? "start"
            : share == 1.0 ? "end"
                           : "middle")
        << "\">" << shortText(x) << (share == 1.0 ? " " + htmlText(axis) : "") << "</text>\n";
  }
  for (const PageCurve& c : curves) {
    bool open = false;
    for (std::size_t k = 0; k < c.x.size(); ++k) {
      const bool is = std::isfinite(c.y[k]);
      if (is && !open) svg << "<polyline fill=\"none\" stroke=\"" << c.colour << "\" points=\"";
      if (is)
        svg << std::round(10.0 * px(c.x[k])) / 10.0 << "," << std::round(10.0 * py(c.y[k])) / 10.0
            << " ";
      if (open && !is) svg << "\"/>\n";
      open = is;
    }
    if (open) svg << "\"/>\n";
  }
  svg << "</svg>\n";
  return svg.str();
}

std::string withUnit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

std::string pictures(const ControlRecord& r, const LoopHealth& h) {
  const double hours = r.sample_time_s / 3600.0;
  std::vector<PageCurve> trend{trendOf("measured", "#1f77b4", r.y, hours)};
  if (!r.setpoint.empty()) trend.push_back(trendOf("setpoint", "#d62728", r.setpoint, hours));
  std::string all = picture(withUnit(r.output, r.unit), "h", trend);
  if (!r.u.empty())
    all += picture(withUnit(r.input, r.input_unit), "h", {trendOf("asked", "#2ca02c", r.u, hours)});
  std::vector<double> error(r.y.size());
  for (std::size_t k = 0; k < error.size(); ++k)
    error[k] = r.y[k] - (r.setpoint.empty() ? 0.0 : r.setpoint[k]);
  const double span =
      h.oscillation.found ? 8.0 * h.oscillation.period : 8.0 * h.settling_s / r.sample_time_s;
  const auto block = static_cast<Eigen::Index>(std::max(1.0, std::floor(span / 400.0)));
  const double step = r.sample_time_s * static_cast<double>(block);
  const auto lags = static_cast<Eigen::Index>(std::min(400.0, span / static_cast<double>(block)));
  all += picture("autocorrelation of the error", "s",
                 {trendOf("", "#1f77b4", autocorrelationOf(blockMeans(error, block), lags), step)});
  if (h.response.empty()) return all;
  const StepResponse& own = h.response;
  std::vector<double> low(own.value.size()), high(own.value.size());
  for (std::size_t k = 0; k < low.size(); ++k) {
    low[k] = own.value[k] - 2.0 * own.std[k];
    high[k] = own.value[k] + 2.0 * own.std[k];
  }
  std::vector<PageCurve> steps;
  const bool shown = own.std.back() < 0.5 * std::abs(own.value.back());
  if (shown) {
    steps.push_back(trendOf("record", "#1f77b4", own.value, own.sample_time_s, own.sample_time_s));
    steps.push_back(trendOf("95 %", "#aec7e8", low, own.sample_time_s, own.sample_time_s));
    steps.push_back(trendOf("", "#aec7e8", high, own.sample_time_s, own.sample_time_s));
  }
  if (!r.model.empty()) {
    std::vector<double> model;
    for (std::size_t k = 0; k < own.value.size(); ++k)
      model.push_back(r.model.at(own.sample_time_s * static_cast<double>(k + 1)));
    steps.push_back(trendOf("model", "#d62728", model, own.sample_time_s, own.sample_time_s));
  }
  if (!steps.empty()) all += picture("answer to a step of the input", "s", steps);
  return all;
}

const char* kPageHead =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><style>body{font:15px "
    "sans-serif;max-width:900px;margin:1em auto}table{border-collapse:collapse}td,th{padding:2px "
    "10px;border-bottom:1px solid #ddd;text-align:left}svg{width:100%;font-size:11px}"
    ".healthy{background:#dfd}.fault{background:#fdd}.unknown{background:#eee}</style><title>";

const char* classOf(LoopCause cause) {
  return cause == LoopCause::kHealthy   ? "healthy"
         : cause == LoopCause::kUnknown ? "unknown"
                                        : "fault";
}

std::vector<std::vector<std::string>> plantRows(const std::vector<NamedRecord>& records,
                                                const std::vector<LoopHealth>& loops) {
  std::vector<std::vector<std::string>> rows{{"loop", "cause", "Harris", "automatic [%]",
                                              "at limits [%]", "fallback [%]", "period [s]",
                                              "error std", "dead time [s]"}};
  const auto rounded = [](double v) { return std::round(1000.0 * v) / 1000.0; };
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const LoopHealth& h = loops[i];
    rows.push_back({records[i].name, nameOf(h.cause), shortText(rounded(h.harris.index)),
                    shortText(rounded(100.0 * h.automatic)),
                    shortText(rounded(100.0 * h.at_limits)), shortText(rounded(100.0 * h.fallback)),
                    shortText(h.periodS()), shortText(h.error_std), shortText(h.dead_time_s)});
  }
  return rows;
}

std::string indexPage(const std::vector<NamedRecord>& records,
                      const std::vector<LoopHealth>& loops) {
  std::ostringstream page;
  page << kPageHead << "Loops</title></head><body><h1>Loops</h1>\n<table>\n";
  const auto rows = plantRows(records, loops);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    page << (i == 0 ? "<tr>" : "<tr class=\"" + std::string(classOf(loops[i - 1].cause)) + "\">");
    for (std::size_t j = 0; j < rows[i].size(); ++j) {
      const std::string cell = htmlText(rows[i][j]);
      if (i == 0)
        page << "<th>" << cell << "</th>";
      else if (j == 0)
        page << "<td><a href=\"" << cell << ".html\">" << cell << "</a></td>";
      else
        page << "<td>" << cell << "</td>";
    }
    page << "</tr>\n";
  }
  page << "</table></body></html>\n";
  return page.str();
}

std::string loopPage(const NamedRecord& named, const LoopHealth& h) {
  std::ostringstream page;
  page << kPageHead << htmlText(named.name) << "</title></head><body><h1>" << htmlText(named.name)
       << "</h1>\n<p class=\"" << classOf(h.cause) << "\"><b>" << nameOf(h.cause)
       << "</b>: " << adviceOf(h.cause) << ".</p>\n<ul>";
  for (const std::string& remark : h.remarks) page << "<li>" << htmlText(remark) << ".</li>\n";
  page << "</ul>\n" << pictures(named.record, h) << "<table>\n";
  for (const auto& [name, value] : figuresOf(h))
    page << "<tr><td>" << htmlText(name) << "</td><td>" << htmlText(value) << "</td></tr>\n";
  page << "</table>\n<p><a href=\"index.html\">all loops</a></p></body></html>\n";
  return page.str();
}

}  // namespace

OrderedJson toJson(const LoopHealth& h, const std::string& name) {
  OrderedJson json;
  json["name"] = name;
  json["output"] = h.output;
  json["input"] = h.input;
  json["cause"] = nameOf(h.cause);
  json["advice"] = adviceOf(h.cause);
  json["samples"] = h.samples;
  json["missing"] = h.missing;
  json["sample_time_s"] = h.sample_time_s;
  json["automatic"] = h.automatic;
  json["manual"] = h.manual;
  json["fallback"] = h.fallback;
  json["held"] = h.held;
  json["at_limits"] = h.at_limits;
  json["harris"] = {{"index", numberOrNull(h.harris.index)},
                    {"std_least", numberOrNull(h.harris.std_least)},
                    {"std_error", numberOrNull(h.harris.std_error)},
                    {"samples", h.harris.samples}};
  json["dead_time_s"] = numberOrNull(h.dead_time_s);
  json["dead_time"] = nameOf(h.dead_time_source);
  json["error_mean"] = numberOrNull(h.error_mean);
  json["error_std"] = numberOrNull(h.error_std);
  json["settling_s"] = numberOrNull(h.settling_s);
  json["error_under_pi"] = numberOrNull(h.error_under_pi);
  if (h.oscillation.found)
    json["oscillation"] = {{"period_s", h.periodS()},
                           {"amplitude", numberOrNull(h.oscillation.amplitude)},
                           {"regularity", numberOrNull(h.oscillation.regularity)},
                           {"share", numberOrNull(h.oscillation.share)},
                           {"unrest", numberOrNull(h.oscillation.unrest)}};
  json["valve"] = {{"dead_band", h.valve.band},
                   {"slip_jump", h.valve.jump},
                   {"explains", h.valve.share},
                   {"significance", numberOrNull(h.valve.significance)},
                   {"certain", h.valve.sticks || h.valve.plays}};
  json["sensor"] = {{"frozen", h.sensor.frozen},
                    {"spikes", h.sensor.spikes},
                    {"resolution", numberOrNull(h.sensor.resolution)}};
  if (h.model.judged)
    json["model"] = {{"distance", numberOrNull(h.model.distance)},
                     {"certainty", numberOrNull(h.model.certainty)},
                     {"gain_ratio", numberOrNull(h.model.gain_ratio)},
                     {"out_of_date", h.model.outdated}};
  json["remarks"] = h.remarks;
  return json;
}

std::string healthTable(const std::vector<NamedRecord>& records,
                        const std::vector<LoopHealth>& loops) {
  return alignedTable(plantRows(records, loops));
}

void writeHealth(const std::vector<NamedRecord>& records, const std::vector<LoopHealth>& loops,
                 const std::string& folder) {
  makeFolder(folder);
  OrderedJson json = OrderedJson::object();
  for (std::size_t i = 0; i < loops.size(); ++i) {
    writeText(loopPage(records[i], loops[i]), inFolder(folder, records[i].name + ".html"));
    json["loops"].push_back(toJson(loops[i], records[i].name));
  }
  writeText(indexPage(records, loops), inFolder(folder, "index.html"));
  writeText(json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n",
            inFolder(folder, "health.json"));
}

}  // namespace fpc::tool
