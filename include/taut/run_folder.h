/// Folder of a run, written as one transaction (docs/cli.md): trace.h5, optionally trace.csv,
/// inputs.yaml, summary.json, optionally report.html. A folder has one writer, all files carry the
/// run's id, and readers refuse files of different runs. The previous run stays complete until the
/// new trace has its first row on the disk, which replaces the old trace. Then the other old files
/// are removed, the summary first; inputs.yaml is replaced last. If a writer is killed in between,
/// the next reader or writer completes the replacement.
///
/// Threads: a `RunFolder` is used by one thread at a time; any number may call the functions at
/// once.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/files.h"
#include "taut/trace.h"

namespace taut {

/// Key of the run's id in a trace's metadata and in a summary.
inline constexpr char kRunIdKey[] = "run";

/// Returns a unique id of 16 hexadecimal digits.
std::string NewRunId();

/// Returns the content of a run's `inputs.yaml`: the experiment's text after a first line with the
/// id.
std::string InputsOfRun(const std::string& id, const std::string& experiment);

/// Removes unnamed files of a killed writer. The caller must be the folder's writer.
void RemoveLeftovers(const std::string& folder);

/// Removes the files of the previous run, the summary first, except for those in `kept`, which the
/// caller replaces atomically. The caller must be the folder's writer. Returns false, with an
/// error, if one cannot be removed.
bool RemoveRunBefore(const std::string& folder, const std::vector<std::string>& kept,
                     Diagnostics& out);

/// Writer of a run's folder.
class RunFolder {
 public:
  /// Creates the folder and becomes its only writer. `more`: names of further files of the run.
  /// Returns null, with an error, if that fails.
  static std::unique_ptr<RunFolder> Open(const std::string& folder,
                                         const std::vector<std::string>& more, Diagnostics& out);
  ~RunFolder();

  const std::string& id() const { return id_; }
  std::string Path(const std::string& name) const;

  /// Writes the experiment's text to the disk, still without a name. Returns false, with an error,
  /// if there is no space; the folder then still contains all of the previous run.
  bool Prepare(const std::string& experiment, Diagnostics& out);

  /// Begins the run: removes the files of the previous run, the summary first, except for `traces`,
  /// which belong to this run already. Then publishes inputs.yaml, if it was prepared; logs of a
  /// robot have none. Returns false, with a diagnostic, if that fails.
  bool Begin(Diagnostics& out, const std::vector<std::string>& traces = {});

  /// Returns a writer that begins the run as soon as `last` has its first row, so that the previous
  /// run stays complete until then. `traces`: names of all traces of the run; `last` must get each
  /// row after the others. The folder must outlive the writer.
  std::unique_ptr<TraceWriter> BeginWith(std::unique_ptr<TraceWriter> last,
                                         std::vector<std::string> traces);

  /// Writes the summary, once all traces are finished, and thereby ends the run. Returns false,
  /// with an error, if it cannot be written or the folder has been deleted or replaced.
  bool Finish(const std::string& summary_json, Diagnostics& out);

 private:
  RunFolder(std::string folder, const std::vector<std::string>& more,
            std::unique_ptr<FolderLock> lock);

  std::string folder_, id_;
  std::vector<std::string> more_;  ///< Also removed at the start of a run.
  std::unique_ptr<FolderLock> lock_;
  std::unique_ptr<NewFile> inputs_;
};

/// Returns the path of another file of a trace's run: for `trace.h5`, "summary" and ".json" it is
/// `summary.json`, for `trace_2.h5` (a live run that was reset) `summary_2.json`.
std::string BesideTrace(const std::string& trace, const std::string& name, const std::string& end);

/// Returns the path of a run's trace: for a run's folder, the trace in it (`trace.h5`, else the CSV
/// trace); for other paths, the path itself.
std::string TraceOfRun(const std::string& path);

/// Reads a trace or that of a run's folder; refuses it if inputs or summary are of another run. A
/// CSV trace has no id, so for it only inputs and summary are compared.
std::optional<Trace> ReadTraceOfRun(const std::string& path, Diagnostics& out);

}  // namespace taut
