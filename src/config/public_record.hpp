// Records that are public and do not ship: where each is had (config/records.yaml).
#pragma once

#include <string>

namespace fpc {

/// The folder that records are looked for in.
inline constexpr char kRecordFolder[] = "FMBPC_DATA";

/// Where the file of this name is had, and with which checksum it goes into which folder; empty for
/// a name that is no public record's. `file`: a path, of which the last part counts.
std::string whereToGet(const std::string& file);

}  // namespace fpc
