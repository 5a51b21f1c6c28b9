/// Folder of a run, written as one transaction (docs/cli.md). Files: trace.h5, inputs.yaml,
/// summary.json, and optionally trace.csv and report.html. A folder has one writer at a time. All
/// files contain the id of the run, and readers reject files of different runs. The previous run
/// remains complete until the new trace has its first row on the disk and replaces the old one.
/// Then the other old files are removed, the summary first, and inputs.yaml is replaced last. If a
/// writer is killed during this replacement, the next reader or writer completes it.
///
/// Threads: only one thread at a time may use a `RunFolder`. Any number may call the functions
/// concurrently.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/files.h"
#include "taut/trace.h"

namespace taut {

/// Key for the id of a run in trace metadata and in summaries.
inline constexpr char kRunIdKey[] = "run";

/// Returns a unique id of 16 hexadecimal digits.
std::string NewRunId();

/// Returns the contents of `inputs.yaml`: a line with the id, then the text of the experiment.
std::string InputsOfRun(const std::string& id, const std::string& experiment);

/// Removes temporary files of a killed writer. Only the writer of the folder may call this.
void RemoveLeftovers(const std::string& folder);

/// Removes the files of the previous run, the summary first. Files in `kept` remain, because the
/// caller replaces them atomically. Only the writer of the folder may call this. Returns false and
/// adds an error if a file cannot be removed.
bool RemoveRunBefore(const std::string& folder, const std::vector<std::string>& kept,
                     Diagnostics& out);

/// Writer of the folder of a run.
class RunFolder {
 public:
  /// Creates the folder and becomes its only writer. `more`: names of further files of the run. On
  /// failure, returns null and adds an error.
  static std::unique_ptr<RunFolder> Open(const std::string& folder,
                                         const std::vector<std::string>& more, Diagnostics& out);
  ~RunFolder();

  const std::string& id() const { return id_; }
  std::string Path(const std::string& name) const;

  /// Writes the text of the experiment to a temporary file on the disk; empty for a run without an
  /// experiment. Returns false, with an error, without space; the previous run remains complete.
  bool Prepare(const std::string& experiment, Diagnostics& out);

  /// Begins the run. Removes the files of the previous run, the summary first, except `traces`,
  /// which already belong to this run. Then publishes inputs.yaml, except for runs without an
  /// experiment, such as logs of a robot. On failure, returns false and adds an error.
  bool Begin(Diagnostics& out, const std::vector<std::string>& traces = {});

  /// Returns a writer that begins the run when `last` has its first row, so that the previous run
  /// stays complete until then. `traces`: names of all traces of the run. `last` must receive each
  /// row after the other writers. The folder must outlive the returned writer.
  std::unique_ptr<TraceWriter> BeginWith(std::unique_ptr<TraceWriter> last,
                                         std::vector<std::string> traces);

  /// Writes the summary and thereby ends the run. Call it after all traces are finished. Returns
  /// false and adds an error if it cannot be written, or if the folder was deleted or replaced.
  bool Finish(const std::string& summary_json, Diagnostics& out);

 private:
  RunFolder(std::string folder, const std::vector<std::string>& more,
            std::unique_ptr<FolderLock> lock);

  std::string folder_, id_;
  std::vector<std::string> more_;  ///< Further files to remove at the start of a run.
  std::unique_ptr<FolderLock> lock_;
  std::unique_ptr<NewFile> inputs_;
};

/// Returns the path of another file of the run of a trace. For `trace.h5`, "summary" and ".json":
/// `summary.json`. For `trace_2.h5` (a live run after a reset): `summary_2.json`.
std::string BesideTrace(const std::string& trace, const std::string& name, const std::string& end);

/// Returns the trace in the folder of a run (`trace.h5`, otherwise the CSV trace). Other paths are
/// returned unchanged.
std::string TraceOfRun(const std::string& path);

/// Returns the text of inputs.yaml or summary.json. Returns nothing, without a message, if the file
/// is missing, larger than 256 MiB, or a pipe or a device, which may never end.
std::optional<std::string> ReadRunText(const std::string& path);

/// Reads a trace, or the trace in the folder of a run. Rejects it if inputs or summary belong to
/// another run. A CSV trace has no id, so only inputs and summary are compared.
std::optional<Trace> ReadTraceOfRun(const std::string& path, Diagnostics& out);

}  // namespace taut
