/// A trace and what is known about it: the experiment beside it, the summary, other runs to compare
/// with. Replays and reports are made of this.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frame.h"
#include "node_channels.h"
#include "pyramid.h"
#include "scene.h"
#include "taut/spec.h"
#include "taut/trace.h"

namespace taut::viewer {

class Recorded {
 public:
  /// Reads the trace at `path` and, from its folder, inputs.yaml and summary.json where they are
  /// there and fit. `compare`: traces of other runs; if empty, what the experiment names. Nothing
  /// and diagnostics, about all of them, if one cannot be read.
  static std::unique_ptr<Recorded> Load(const std::string& path,
                                        const std::vector<std::string>& compare, Diagnostics& out);

  const std::string& path() const { return path_; }
  /// The experiment's name; the file's where that is not known.
  std::string title() const;
  const Trace& trace() const { return trace_; }
  /// The runs that it is compared with: series of the k-th have source k, from 1.
  const std::vector<std::unique_ptr<Recorded>>& compared() const { return compared_; }
  /// What to call it beside those; empty if there are none.
  const std::string& run_name() const { return run_name_; }
  const std::optional<ExperimentSpec>& experiment() const { return experiment_; }
  const std::string& inputs() const { return inputs_; }  ///< The text of inputs.yaml, or empty.
  const Json& summary() const { return summary_; }       ///< Or null.
  const std::string& notice() const { return notice_; }  ///< What is amiss, or empty.

  Json scene() const;
  /// What a row of the trace shows.
  Frame FrameOf(std::size_t row) const;
  /// The last row at or before a time; 0 before the first.
  std::size_t RowAt(double time_s) const;
  /// A channel of the trace or a place of a node (source 0), or the same of a compared run; nothing
  /// if there is none.
  std::optional<Series> SeriesOf(const std::string& channel, int source, double t0, double t1,
                                 std::size_t points) const;

 private:
  /// Compared with nothing.
  static std::unique_ptr<Recorded> LoadAlone(const std::string& path, Diagnostics& out);
  void FindInputs();
  void FindColumns();
  void FindForces();
  /// All columns of these names after a prefix; false if one is missing.
  template <std::size_t count>
  bool FindAll(const std::string& prefix, const char* const (&names)[count],
               const std::vector<double>* (&columns)[count]) const;
  bool has_poses() const;
  std::vector<Frame::Body> PosesOf(std::size_t row) const;
  /// The bends in a row, of cables whose numbers begin at `first`.
  void AddBends(std::size_t row, int first, std::vector<Frame::Bend>& bends) const;
  /// Adds its ghost at a time of another run: NaN where it has no row. `first_cable`: its number.
  void AddGhost(double time_s, int first_cable, Frame& frame) const;
  Json ComparedRun() const;
  /// The column of a channel, or null.
  const std::vector<double>* Column(const std::string& name) const;

  struct NodeColumn {
    std::vector<double> values;
    Pyramid pyramid;
  };
  /// Nothing if the trace does not have the whole pose of the node's body.
  std::optional<NodeChannels::Poses> PosesOf(const NodeChannels::Place& node) const;
  /// Null if that is not the place of a node, or the body's pose is not in the trace.
  const NodeColumn* Node(const std::string& name) const;

  struct BodyColumns {
    const std::vector<double>* values[7];  ///< Null: as at the start.
    Frame::Body start;
  };
  struct CableColumns {
    const std::vector<double>* values[4];
    std::vector<const std::vector<double>*> bends;  ///< x, y, z of each; empty: drawn straight.
    std::vector<const std::vector<double>*> spans;  ///< Tensions; empty: it has one.
  };
  struct ForceColumn {
    int node = 0;
    Vec3 direction;
    const std::vector<double>* value;
  };
  struct HandColumns {
    const std::vector<double>* values[4];
  };
  struct ContactColumns {
    const std::vector<double>* values[6];
  };

  std::string path_, inputs_, notice_, run_name_;
  Trace trace_;
  std::vector<std::unique_ptr<Recorded>> compared_;
  std::optional<ExperimentSpec> experiment_;
  NodeChannels nodes_;
  Json summary_;
  std::vector<BodyColumns> bodies_;
  std::vector<CableColumns> cables_;
  std::vector<ForceColumn> forces_;
  std::vector<HandColumns> hands_;
  std::vector<ContactColumns> contacts_;
  const std::vector<double>* energy_[3] = {};
  const std::vector<double>* contact_count_ = nullptr;
  mutable std::map<std::size_t, Pyramid> pyramids_;         ///< By channel; made when asked for.
  mutable std::map<std::string, NodeColumn> node_columns_;  ///< The same.
};

}  // namespace taut::viewer
