/// The folder that a run writes (docs/cli.md): trace.h5, perhaps trace.csv, inputs.yaml,
/// summary.json, perhaps report.html. A run is one transaction: its folder has one writer, all
/// pieces carry the run's id, and readers refuse pieces of different runs. The run before stays
/// complete until the new trace has its first row on the disk, which replaces the old trace. Then
/// the other old pieces are removed, the summary first; inputs.yaml is replaced last. If a writer
/// is killed in between, the next reader or writer completes the replacement.
///
/// Threads: a `RunFolder` belongs to one thread at a time; the functions may be called by any
/// number at once.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/files.h"
#include "taut/trace.h"

namespace taut {

/// The key under which a trace's metadata and a summary have the run's id.
inline constexpr char kRunIdKey[] = "run";

/// 16 hexadecimal digits that no other run has.
std::string NewRunId();

/// `inputs.yaml` of a run: the experiment's text after a first line with the id.
std::string InputsOfRun(const std::string& id, const std::string& experiment);

/// Removes unnamed files of a killed writer. The caller must be the folder's writer.
void RemoveLeftovers(const std::string& folder);

/// Removes from a folder whose writer the caller is the pieces of the run before, the summary
/// first, but for those in `kept`: the caller replaces these, each at once. False and a complaint
/// if one cannot be removed.
bool RemoveRunBefore(const std::string& folder, const std::vector<std::string>& kept,
                     Diagnostics& out);

class RunFolder {
 public:
  /// Makes the folder and becomes its only writer. `more`: names of what will be written there
  /// besides the pieces above. Null and a complaint if that fails.
  static std::unique_ptr<RunFolder> Open(const std::string& folder,
                                         const std::vector<std::string>& more, Diagnostics& out);
  ~RunFolder();

  const std::string& id() const { return id_; }
  std::string Path(const std::string& name) const;

  /// Puts the text of the experiment on the disk, still without a name. False and a complaint if
  /// there is no room: then what the folder holds is still all of the run before.
  bool Prepare(const std::string& experiment, Diagnostics& out);

  /// Begins the run: removes the pieces of the run before, the summary first, except for `traces`,
  /// which are of this run already. Then publishes inputs.yaml, if it was prepared; logs of a robot
  /// have none. Returns false, with a diagnostic, if that fails.
  bool Begin(Diagnostics& out, const std::vector<std::string>& traces = {});

  /// Returns a writer that begins the run as soon as `last` has its first row, so that the run
  /// before stays complete until then. `traces`: names of all traces of the run; `last` must get
  /// each row after the others. The folder must outlive the writer.
  std::unique_ptr<TraceWriter> BeginWith(std::unique_ptr<TraceWriter> last,
                                         std::vector<std::string> traces);

  /// The run's last word, once its traces are finished. False and a complaint if it cannot be
  /// written or the folder is no longer ours.
  bool Finish(const std::string& summary_json, Diagnostics& out);

 private:
  RunFolder(std::string folder, const std::vector<std::string>& more,
            std::unique_ptr<FolderLock> lock);

  std::string folder_, id_;
  std::vector<std::string> more_;  ///< Removed at the beginning, too.
  std::unique_ptr<FolderLock> lock_;
  std::unique_ptr<NewFile> inputs_;
};

/// The path of what a run wrote beside its trace: of `trace.h5`, "summary" and ".json" it is
/// `summary.json`, of `trace_2.h5` (a live run that was reset) `summary_2.json`.
std::string BesideTrace(const std::string& trace, const std::string& name, const std::string& end);

/// Where the trace of a run is: of a run's folder the one in it (`trace.h5`; without one, that in
/// CSV), of anything else the path itself.
std::string TraceOfRun(const std::string& path);

/// As `ReadTrace`, and refuses a trace beside which there are inputs or a summary of another run. A
/// trace in CSV has no id, so there only the other two are held against each other.
std::optional<Trace> ReadTraceOfRun(const std::string& path, Diagnostics& out);

}  // namespace taut
