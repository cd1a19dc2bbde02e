#include "tool/read_record.hpp"

#include <array>
#include <filesystem>
#include <fstream>

#include "base/csv_header.hpp"
#include "config/public_record.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/bag_reader.hpp"

namespace fpc::tool {
namespace {

bool isBag(const std::string& file) {
  static const std::string magic = "#ROSBAG";
  std::array<char, 7> start{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), start.size());
  return std::string(start.data(), start.size()) == magic ||
         std::filesystem::path(file).extension() == ".bag";
}

}  // namespace

CsvTable readRecord(const std::string& file, const CsvFormat& format, bool header) {
  if (!std::filesystem::is_regular_file(file)) {
    const std::string record = whereToGet(file);
    throw InputError(file + ": expected an existing CSV or bag" +
                     (record.empty() ? "" : ": " + record));
  }
  if (isBag(file)) return readBag(file);
  return header ? readCsv(file, format) : readCsvWithoutHeader(file, format);
}

}  // namespace fpc::tool
