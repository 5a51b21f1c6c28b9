/// Viewer page: displays data of a C++ program in a browser, for robots simulated by taut or from
/// other sources.
///
///     taut::Diagnostics out;
///     const auto page = taut::Page::Open({}, out);      // open page->url() in a browser
///     const int robot = page->Add(model->def());
///     for (...) {
///       batch.Step(step_s);
///       page->Set(robot, batch);
///       page->Show(batch.Time(0));
///     }
///
/// Users can pause, slow down, look back and plot, as in a live run (docs/viewer.md). SI units;
/// world frame W as in taut/model_def.h.
///
/// Threads: only one thread at a time may call functions of a page. The server has its own threads.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/world_batch.h"

namespace taut {

struct ExperimentSpec;  // taut/spec.h

struct PageOptions {
  std::string title = "taut";
  /// Playback speed: simulated time / real time, > 0. 0: `Show` does not wait. Users can change the
  /// speed in the browser.
  double speed = 1;
  /// Address to listen on; the default accepts only connections from this machine.
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< Port of the server; 0: any free port.
  /// Folder of the viewer's files, used if neither $TAUT_WEB nor the folder of the program contains
  /// them.
#ifdef TAUT_WEB_FOLDER  // set by the CMake target
  std::string web_folder = TAUT_WEB_FOLDER;
#else
  std::string web_folder;
#endif
  /// Simulated time between states that are kept to look back, > 0.
  double history_period_s = 0.01;
  /// Whether a pause in the browser makes `Show` wait. If false, `Show` never waits: a pause only
  /// holds the picture, and `speed` must be 0.
  bool browser_pauses = true;
  /// Origins of other pages that may contain this page in a frame, as in the directive
  /// frame-ancestors of Content-Security-Policy ("http://localhost:*").
  std::string frame_ancestors = "'none'";
};

/// State of a robot at one time. Each list has the length of the corresponding list of its
/// `ModelDef`, or is empty if unknown.
struct RobotMoment {
  std::vector<BodyState> bodies;  ///< Velocities are not displayed.
  std::vector<double> tension_n, length_m, rest_length_m, set_point_n;  ///< One per cable.
  /// Per cable: bend points from cable wrapping, in order along the cable, in W; empty for cables
  /// without wrapping.
  std::vector<std::vector<Vec3>> bends_m;
  /// Per cable: tensions of the spans, in order along the cable; empty for cables without friction.
  std::vector<std::vector<double>> span_tension_n;
  std::vector<Vec3> node_force_n;  ///< Per node: external force, in W.
  /// Contacts to draw, in any number; empty if unknown.
  std::vector<ContactState> contacts;
  Energy energy{NAN, NAN, NAN};  ///< NaN: unknown. The page displays the sum of all robots.
};

/// Returns the current state of a world of a batch, without set points.
RobotMoment MomentOf(const WorldBatch& batch, int world);

/// Web server with a viewer page for one or more robots.
class Page {
 public:
  /// Starts the server. On failure, returns null and adds diagnostics: port in use, invalid
  /// address, viewer files not found, or options out of range.
  static std::unique_ptr<Page> Open(const PageOptions& options, Diagnostics& out);
  ~Page();  ///< Connected browsers report that the program has ended.
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  /// Return addresses of the page, each with a secret token. `url` allows pausing and seeking,
  /// `watch_url` only watching.
  const std::string& url() const noexcept;
  const std::string& watch_url() const noexcept;

  /// Adds a robot, displaced by `at_m`, and returns its number. The page displays the terrain of
  /// the first robot, and terrain of further robots if it differs. `name` is the prefix of names of
  /// bodies, cables and nodes ("left/rod_0"); it may be empty for a single robot. The page restarts
  /// without its history.
  int Add(const ModelDef& robot, const std::string& name = "", const Vec3& at_m = {});
  /// Same for the robot of an experiment. The page also displays tags, phases and events of the
  /// experiment, as long as this robot is the only one.
  int Add(const ExperimentSpec& experiment);

  /// Sets the state of a robot for the next `Show`. A robot without a state has its described pose.
  /// The first `Show` after an `Add` determines which cables have set points. An unknown robot or
  /// world, or a list of wrong length, prints a message on stderr and calls abort().
  void Set(int robot, const WorldBatch& batch, int world = 0);
  void Set(int robot, const RobotMoment& moment);

  /// Sets the value of a custom channel for the next `Show`, such as "reward" or "error/roll_rad".
  /// The first value creates the channel; if the page has already displayed data, it restarts.
  void Plot(const std::string& channel, const std::string& unit, double value);

  /// Displays the current states at time `time_s`. Waits according to the speed, and while the page
  /// is paused. A time before the previous call's time starts a new run.
  void Show(double time_s);

 private:
  struct Impl;
  explicit Page(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
