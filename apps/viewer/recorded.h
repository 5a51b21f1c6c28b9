/// Trace with its experiment, its summary and runs to compare with: the data of replays and
/// reports.
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
  /// Reads the trace at `path` and, from its folder, inputs.yaml and summary.json if they exist and
  /// match. `compare`: traces of other runs; if empty, the experiment's reference. If a trace
  /// cannot be read, returns null, with an error in `out` for each unreadable trace.
  static std::unique_ptr<Recorded> Load(const std::string& path,
                                        const std::vector<std::string>& compare, Diagnostics& out);

  const std::string& path() const { return path_; }
  /// Returns the experiment's name, or the file's name if the experiment is unknown.
  std::string title() const;
  const Trace& trace() const { return trace_; }
  /// Returns the compared runs; the series of run k have source k, counting from 1.
  const std::vector<std::unique_ptr<Recorded>>& compared() const { return compared_; }
  /// Returns the name of this run among the compared runs; empty without any.
  const std::string& run_name() const { return run_name_; }
  const std::optional<ExperimentSpec>& experiment() const { return experiment_; }
  const std::string& inputs() const { return inputs_; }  ///< Text of inputs.yaml, or empty.
  const Json& summary() const { return summary_; }       ///< Null without summary.json.
  const std::string& notice() const { return notice_; }  ///< Description of a defect, or empty.

  Json scene() const;
  /// Returns the frame of a row of the trace.
  Frame FrameOf(std::size_t row) const;
  /// Returns the last row at or before a time; 0 before the first.
  std::size_t RowAt(double time_s) const;
  /// Returns a channel of the trace or a coordinate of a node: of this run (source 0) or of a
  /// compared run; nothing if it does not exist.
  std::optional<Series> SeriesOf(const std::string& channel, int source, double t0, double t1,
                                 std::size_t points) const;

 private:
  /// Loads a run without comparison.
  static std::unique_ptr<Recorded> LoadAlone(const std::string& path, Diagnostics& out);
  void FindInputs();
  void FindColumns();
  void FindForces();
  /// Finds all columns of these names after a prefix; returns false if one is missing.
  template <std::size_t count>
  bool FindAll(const std::string& prefix, const char* const (&names)[count],
               const std::vector<double>* (&columns)[count]) const;
  bool has_poses() const;
  std::vector<Frame::Body> PosesOf(std::size_t row) const;
  /// Adds the bends in a row; cable numbers begin at `first`.
  void AddBends(std::size_t row, int first, std::vector<Frame::Bend>& bends) const;
  /// Adds this run's ghost at a time of another run; NaN if this run has no row at that time.
  /// `first_cable`: number of the ghost's first cable.
  void AddGhost(double time_s, int first_cable, Frame& frame) const;
  Json ComparedRun() const;
  /// Returns the column of a channel, or null.
  const std::vector<double>* Column(const std::string& name) const;

  struct NodeColumn {
    std::vector<double> values;
    Pyramid pyramid;
  };
  /// Returns nothing if the trace lacks part of the pose of the node's body.
  std::optional<NodeChannels::Poses> PosesOf(const NodeChannels::Place& node) const;
  /// Returns null if the name is not a coordinate of a node, or the body's pose is not in the
  /// trace.
  const NodeColumn* Node(const std::string& name) const;

  struct BodyColumns {
    const std::vector<double>* values[7];  ///< Null: constant, as at the start.
    Frame::Body start;
  };
  struct CableColumns {
    const std::vector<double>* values[4];
    std::vector<const std::vector<double>*> bends;  ///< x, y, z of each; empty: drawn straight.
    std::vector<const std::vector<double>*> spans;  ///< Tensions of the spans; empty: one tension.
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
  mutable std::map<std::size_t, Pyramid> pyramids_;         ///< Pyramid of each channel, created on
                                                            ///< demand.
  mutable std::map<std::string, NodeColumn> node_columns_;  ///< Coordinates of nodes, created on
                                                            ///< demand.
};

}  // namespace taut::viewer
