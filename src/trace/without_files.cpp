// Stubs for builds that cannot read trace files (browser).
#include <utility>

#include "trace/hdf5_table.h"
#include "trace/readers.h"

namespace taut::trace {
namespace {

void Refuse(const std::string& path, const char* what, Diagnostics& out) {
  out.Error("browser.no_files", {path, 0, 0}, std::string(what) + " cannot be read in a browser",
            "use the command-line program taut");
}

}  // namespace

std::optional<Trace> ReadHdf5(const std::string& path, Diagnostics& out) {
  Refuse(path, "traces", out);
  return std::nullopt;
}

std::optional<Trace> ReadCsv(const std::string& path, Diagnostics& out) {
  Refuse(path, "traces", out);
  return std::nullopt;
}

std::optional<Trace> ReadMcap(const std::string& path, Diagnostics& out) {
  Refuse(path, "traces", out);
  return std::nullopt;
}

std::optional<Hdf5Table> ReadHdf5Table(const std::string& path, const std::string& /*name*/,
                                       TableBudget& /*budget*/, Diagnostics& out) {
  Refuse(path, "tables in HDF5", out);
  return std::nullopt;
}

}  // namespace taut::trace
