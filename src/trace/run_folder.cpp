#include "taut/run_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <vector>

#include "base/input_file.h"

namespace taut {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInputs = "inputs.yaml";
constexpr const char* kSummary = "summary.json";
/// Files of a run, in the order in which a new run removes them.
constexpr const char* kPieces[] = {kSummary,    "report.html", "events.jsonl", "host.h5",
                                   "trace.csv", "trace.h5",    kInputs};
constexpr std::string_view kIdLine = "# run ";

/// Removes a prefix from `text`. Returns nothing if `text` does not begin with it.
std::optional<std::string_view> After(std::string_view text, std::string_view beginning) {
  if (!text.starts_with(beginning)) return std::nullopt;
  return text.substr(beginning.size());
}

/// Returns whether a name belongs to an unfinished file: `trace.h5.77.part`, or
/// `trace_2.h5.77.part` of a live run that was reset.
bool IsLeftover(std::string_view name) {
  if (!name.ends_with(".part")) return false;
  return std::any_of(std::begin(kPieces), std::end(kPieces), [&](std::string_view piece) {
    const std::size_t dot = piece.find('.');
    auto rest = After(name, piece.substr(0, dot));
    if (rest && rest->starts_with('_')) {
      rest->remove_prefix(std::min(rest->find_first_not_of("0123456789", 1), rest->size()));
    }
    return rest && (rest = After(*rest, piece.substr(dot))) && rest->starts_with('.');
  });
}

bool RemoveOld(const std::string& path, Diagnostics& out) {
  if (unlink(path.c_str()) == 0 || errno == ENOENT) return true;
  out.Error("folder.old_file_kept", {path},
            fmt::format("cannot remove this file of the previous run: {}", std::strerror(errno)));
  return false;
}

std::string FolderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path().string() : ".";
}

std::string IdOfInputs(const std::string& text) {
  if (!text.starts_with(kIdLine)) return {};
  return text.substr(kIdLine.size(), text.find('\n') - kIdLine.size());
}

std::string IdOfSummary(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains(kRunIdKey) || !json[kRunIdKey].is_string()) return {};
  return json[kRunIdKey].get<std::string>();
}

std::string IdOfTrace(const Trace& trace) {
  const auto has_key = [](const auto& pair) { return pair.first == kRunIdKey; };
  const auto at = std::find_if(trace.metadata.begin(), trace.metadata.end(), has_key);
  return at == trace.metadata.end() ? std::string() : at->second;
}

struct Piece {
  std::string path, id;  ///< `id` is empty for runs of earlier versions.
};

/// Returns the existing files of the run to which a trace belongs.
std::vector<Piece> PiecesOfRun(const std::string& path, const Trace& trace) {
  std::vector<Piece> pieces;
  const std::string id = IdOfTrace(trace);
  // In a run's folder, files called trace* and HDF5 files with an id belong to runs. Other traces
  // there are measured. CSV files contain no id and are not listed.
  const bool named = fs::path(path).filename().string().starts_with("trace");
  if (path.ends_with(".h5") && (named || !id.empty())) {
    pieces.push_back({path, id});
  } else if (!named) {
    return pieces;
  }
  const std::string inputs = BesideTrace(path, "inputs", ".yaml");
  if (const auto text = ReadRunText(inputs)) pieces.push_back({inputs, IdOfInputs(*text)});
  const std::string summary = BesideTrace(path, "summary", ".json");
  if (const auto text = ReadRunText(summary)) pieces.push_back({summary, IdOfSummary(*text)});
  return pieces;
}

/// Returns unpublished input files in the trace's folder. They exist while a run replaces an
/// earlier run: from the first row of the new trace until the old files are removed.
std::vector<Piece> UnnamedInputs(const std::string& trace) {
  const fs::path inputs = BesideTrace(trace, "inputs", ".yaml");
  const std::string name = inputs.filename().string() + ".";
  std::vector<Piece> found;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(FolderOf(inputs), ignored)) {
    const std::string other = entry.path().filename().string();
    if (!other.starts_with(name) || !other.ends_with(".part")) continue;
    const auto text = ReadRunText(entry.path().string());
    if (text) found.push_back({entry.path().string(), IdOfInputs(*text)});
  }
  return found;
}

/// Returns the path of the file with this run id; nothing if there is none.
std::optional<std::string> PathOfRun(const std::vector<Piece>& pieces, const std::string& id) {
  const auto at = std::find_if(pieces.begin(), pieces.end(),
                               [&](const Piece& piece) { return !id.empty() && piece.id == id; });
  return at == pieces.end() ? std::nullopt : std::optional(at->path);
}

/// Returns whether inputs, such as those before their publication, contain an experiment. Those of
/// a robot's log only contain the id.
bool HasExperiment(const std::string& inputs) {
  const auto text = ReadRunText(inputs);
  return !text || *text != InputsOfRun(IdOfInputs(*text), "");
}

/// Completes the replacement of a run, if the writer of this trace began one. The caller must hold
/// the folder's lock.
bool FinishReplacement(const std::string& trace, const std::string& unnamed) {
  const fs::path path(trace);
  const bool has_experiment = HasExperiment(unnamed);
  std::vector<std::string> kept{"trace.h5"};
  if (has_experiment) kept.push_back(kInputs);
  Diagnostics ignored;
  if (path.filename() == "trace.h5" &&
      !RemoveRunBefore(path.parent_path().string(), kept, ignored)) {
    return false;
  }
  if (!has_experiment) return unlink(unnamed.c_str()) == 0;
  return std::rename(unnamed.c_str(), BesideTrace(trace, "inputs", ".yaml").c_str()) == 0;
}

/// Returns the files of a trace's run. If its writer was killed while it replaced another run,
/// first removes the remains of the other run. If the writer is still alive, waits for it.
std::vector<Piece> WholePiecesOfRun(const std::string& path, const Trace& trace) {
  constexpr int kLooks = 50;
  constexpr std::chrono::milliseconds kBetween{20};
  for (int look = 0; look < kLooks; ++look) {
    const auto unnamed = PathOfRun(UnnamedInputs(path), IdOfTrace(trace));
    if (!unnamed) break;  // no interrupted replacement, or a writer has just completed it
    Diagnostics ignored;
    const auto lock = FolderLock::Take(FolderOf(path), ignored);
    if (!lock || !FinishReplacement(path, *unnamed)) std::this_thread::sleep_for(kBetween);
  }
  return PiecesOfRun(path, trace);
}

/// Completes the replacement of the previous run in a folder if the writer of the new run was
/// interrupted. The caller must hold the folder's lock.
void FinishReplacementIn(const std::string& folder) {
  const std::string path = (fs::path(folder) / "trace.h5").string();
  const std::vector<Piece> all = UnnamedInputs(path);
  if (all.empty()) return;
  Diagnostics unread;
  const auto trace = ReadTrace(path, unread);
  const auto unnamed = trace ? PathOfRun(all, IdOfTrace(*trace)) : std::nullopt;
  if (unnamed) FinishReplacement(path, *unnamed);
}

/// Writer of the last of a run's traces. Removes the previous run as soon as all traces have their
/// first row on disk.
class BeginningTrace final : public TraceWriter {
 public:
  BeginningTrace(RunFolder& folder, std::unique_ptr<TraceWriter> writer,
                 std::vector<std::string> traces)
      : folder_(folder), writer_(std::move(writer)), traces_(std::move(traces)) {
    for (const std::string& name : traces_) before_.push_back(IdentityOf(folder_.Path(name)));
  }
  /// Another trace may have replaced its predecessor although this trace failed.
  ~BeginningTrace() override { Begin(); }

  bool Append(double time_s, const double* values) override {
    return error_.empty() && writer_->Append(time_s, values) && Begin();
  }
  bool FlushOld() override { return error_.empty() && writer_->FlushOld(); }
  bool Finish() override {
    // All traces failed before their first row, so keep the previous run.
    if (!begun_ && traces_.size() > 1 && Replaced().empty()) return true;
    return error_.empty() && writer_->Finish() && Begin();
  }
  const std::string& error() const override { return error_.empty() ? writer_->error() : error_; }

 private:
  std::vector<std::string> Replaced() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < traces_.size(); ++i) {
      if (IdentityOf(folder_.Path(traces_[i])) != before_[i]) names.push_back(traces_[i]);
    }
    return names;
  }

  bool Begin() {
    if (begun_) return true;
    const std::vector<std::string> replaced = Replaced();
    if (replaced.empty()) return true;
    begun_ = true;
    Diagnostics out;
    if (folder_.Begin(out, replaced)) return true;
    error_ = out.items().front().at.file + ": " + out.items().front().what;
    return false;
  }

  RunFolder& folder_;
  const std::unique_ptr<TraceWriter> writer_;
  const std::vector<std::string> traces_;
  std::vector<FileIdentity> before_;
  bool begun_ = false;
  std::string error_;
};

}  // namespace

void RemoveLeftovers(const std::string& folder) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    if (IsLeftover(entry.path().filename().string())) found.push_back(entry.path());
  }
  for (const fs::path& path : found) unlink(path.c_str());
}

bool RemoveRunBefore(const std::string& folder, const std::vector<std::string>& kept,
                     Diagnostics& out) {
  for (const std::string piece : kPieces) {
    if (std::find(kept.begin(), kept.end(), piece) != kept.end()) continue;
    if (!RemoveOld((fs::path(folder) / piece).string(), out)) return false;
  }
  return true;
}

RunFolder::RunFolder(std::string folder, const std::vector<std::string>& more,
                     std::unique_ptr<FolderLock> lock)
    : folder_(std::move(folder)), id_(NewRunId()), more_(more), lock_(std::move(lock)) {}

RunFolder::~RunFolder() = default;

std::unique_ptr<RunFolder> RunFolder::Open(const std::string& folder,
                                           const std::vector<std::string>& more, Diagnostics& out) {
  auto lock = FolderLock::Take(folder, out);
  if (!lock) return nullptr;
  FinishReplacementIn(folder);
  RemoveLeftovers(folder);
  return std::unique_ptr<RunFolder>(new RunFolder(folder, more, std::move(lock)));
}

std::string RunFolder::Path(const std::string& name) const {
  return (fs::path(folder_) / name).string();
}

bool RunFolder::Prepare(const std::string& experiment, Diagnostics& out) {
  inputs_ = std::make_unique<NewFile>(Path(kInputs));
  if (inputs_->Create() && inputs_->Write(InputsOfRun(id_, experiment)) && inputs_->Sync()) {
    return true;
  }
  out.Error("file.not_writable", {Path(kInputs)}, "cannot write: " + inputs_->why());
  return false;
}

std::unique_ptr<TraceWriter> RunFolder::BeginWith(std::unique_ptr<TraceWriter> last,
                                                  std::vector<std::string> traces) {
  return std::make_unique<BeginningTrace>(*this, std::move(last), std::move(traces));
}

bool RunFolder::Begin(Diagnostics& out, const std::vector<std::string>& traces) {
  const bool has_experiment = inputs_ && HasExperiment(inputs_->made_at());
  if (inputs_) inputs_->Leave();  // after an error below, the next reader completes the replacement
  std::vector<std::string> replaced = traces;
  if (has_experiment) replaced.push_back(kInputs);
  if (!RemoveRunBefore(folder_, replaced, out)) return false;
  for (const std::string& name : more_) {
    if (!RemoveOld(Path(name), out)) return false;
  }
  if (inputs_ && !has_experiment) return RemoveOld(inputs_->made_at(), out);
  if (!inputs_ || inputs_->Publish()) return true;
  out.Error("file.not_writable", {Path(kInputs)}, "cannot write: " + inputs_->why());
  return false;
}

bool RunFolder::Finish(const std::string& summary_json, Diagnostics& out) {
  if (lock_->Holds()) return WriteWholeFile(Path(kSummary), summary_json, out);
  out.Error("folder.deleted", {folder_},
            "the folder was deleted while the run wrote into it, so there is no summary");
  return false;
}

std::string NewRunId() {
  std::random_device device;  // random numbers of the kernel
  return fmt::format("{:08x}{:08x}", device(), device());
}

std::string InputsOfRun(const std::string& id, const std::string& experiment) {
  return fmt::format("{}{}\n{}", kIdLine, id, experiment);
}

std::string BesideTrace(const std::string& trace, const std::string& name, const std::string& end) {
  const fs::path path(trace);
  std::string stem = path.filename().string();
  stem.erase(std::min(stem.find('.'), stem.size()));
  const std::string suffix = stem.starts_with("trace") ? stem.substr(5) : "";
  return (path.parent_path() / (name + suffix + end)).string();
}

std::string TraceOfRun(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return path;
  const fs::path folder = (fs::path(path) / "").parent_path();  // without a slash at its end
  for (const char* name : {"trace.h5", "trace.csv", "trace.csv.gz"}) {
    if (fs::exists(folder / name, ignored)) return (folder / name).string();
  }
  return (folder / "trace.h5").string();
}

std::optional<std::string> ReadRunText(const std::string& path) {
  constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  Diagnostics unread;
  return base::ReadInputFile(path, kMostBytes, "", unread);
}

std::optional<Trace> ReadTraceOfRun(const std::string& trace_or_folder, Diagnostics& out) {
  const std::string path = TraceOfRun(trace_or_folder);
  auto trace = ReadTrace(path, out);
  if (!trace) return std::nullopt;
  const auto shown = [](const Piece& piece) { return piece.id.empty() ? "none" : piece.id; };
  const std::vector<Piece> pieces = WholePiecesOfRun(path, *trace);
  for (const Piece& piece : pieces) {
    if (piece.id == pieces.front().id) continue;
    out.Error("trace.other_run", {piece.path},
              fmt::format("the file belongs to another run than {} (run {}, not {})",
                          pieces.front().path, shown(piece), shown(pieces.front())),
              "remove the file that does not belong there, or run the experiment again");
    return std::nullopt;
  }
  return trace;
}

}  // namespace taut
