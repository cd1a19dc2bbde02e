// Key `disturbance.csv`: a user's record, how it is written, and what becomes of bad cells.
#include <algorithm>

#include "base/time_unit.hpp"
#include "config/range.hpp"
#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"

namespace fpc {
namespace {

void readCsvChannels(YamlSection& section, CsvDisturbanceParams& params,
                     const std::vector<std::string>& names) {
  YamlSection channels = section.section("channels");
  for (const auto& name : names) {
    channels.markRead(name);
    if (!channels.has(name)) continue;
    YamlSection channel = channels.section(name);
    CsvChannel value;
    value.name = name;
    need(channel, "column", "the name of a column");
    channel.text("column", value.column);
    if (value.column == params.time_column)
      channel.fail("column", "another column than disturbance.csv.time_column");
    channel.number("scale", value.scale, kFinite);
    if (value.scale == 0.0) channel.fail("scale", "a number other than 0");
    channel.number("offset", value.offset, kFinite);
    channel.number("mean", value.mean, kFinite);
    if (channel.has("mean") && value.mean == 0.0) channel.fail("mean", "a number other than 0");
    readRange(channel, "plausible", value.lower, value.upper, kFinite);  // others: missing cells
    if (channel.has("mean") && (channel.has("scale") || channel.has("offset")))
      channel.fail("mean", "either mean, or scale and offset");
    channel.finish();
    params.channels.push_back(std::move(value));
  }
  channels.finish();
}

}  // namespace

void readCsvFormat(YamlSection& section, CsvFormat& format) {
  std::string separator(1, format.separator), decimal(1, format.decimal);
  section.text("separator", separator);
  section.text("decimal", decimal);
  section.names("missing_values", format.missing_values);
  checked(section, [&] {
    format.separator = separatorOf(separator);
    format.decimal = decimalOf(decimal);
    format.validate();
  });
}

void readCsvSection(YamlSection& section, CsvDisturbanceParams& params,
                    const std::vector<std::string>& names) {
  section.text("file", params.file);
  section.text("time_column", params.time_column);
  readCsvFormat(section, params.format);
  section.oneOf("time_unit", params.time_unit, timeUnits());
  readOption(section, "missing", params.missing,
             {{"error", MissingCells::kError},
              {"hold", MissingCells::kHold},
              {"interpolate", MissingCells::kInterpolate}});
  readOption(section, "interpolation", params.interpolation);
  readOption(section, "end", params.end);
  section.number("lead_in_h", params.lead_in_h, {0.0, 1e7});
  YamlSection next = section.section("next");
  next.text("file", params.next_file);
  if (!params.next_file.empty()) need(next, "after_h", "a time > 0");
  next.number("after_h", params.next_after_h, {0.0, 1e7, true});
  next.finish();
  readCsvChannels(section, params, names);
  section.finish();
}

}  // namespace fpc
