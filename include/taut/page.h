/// Viewer page: a C++ program opens the viewer in a browser and displays its data, of robots
/// simulated by taut or from other sources.
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
/// Users can pause, slow down, look back and plot, as with a live run (docs/viewer.md). SI units;
/// world frame W as in taut/model_def.h.
///
/// Threads: the functions of one page must not be called from two threads at once. The server has
/// separate threads.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/world_batch.h"

namespace taut {

struct PageOptions {
  std::string title = "taut";
  /// Playback speed, simulated time over real time, > 0; 0: `Show` does not wait. Users can change
  /// it in the browser.
  double speed = 1;
  /// Address to listen on; the default accepts connections from this machine only.
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: any free port.
  /// Folder of the viewer's files, used if neither $TAUT_WEB nor the program's folder has them.
#ifdef TAUT_WEB_FOLDER  // set by the CMake target
  std::string web_folder = TAUT_WEB_FOLDER;
#else
  std::string web_folder;
#endif
  /// Simulated time between states that are kept for looking back, > 0.
  double history_period_s = 0.01;
};

/// State of a robot at one time. Each list has the length of the same list of its `ModelDef`, or is
/// empty if unknown.
struct RobotMoment {
  std::vector<BodyState> bodies;  ///< Velocities are not displayed.
  std::vector<double> tension_n, length_m, rest_length_m, set_point_n;  ///< Per cable.
  /// Per cable: bends by cable wrapping, in order along the cable, in W; empty for cables that do
  /// not wrap.
  std::vector<std::vector<Vec3>> bends_m;
  /// Per cable: tensions of its spans, in order along the cable; empty for cables without friction.
  std::vector<std::vector<double>> span_tension_n;
  std::vector<Vec3> node_force_n;  ///< Per node: external force, in W.
  /// Contacts, any number; their points and forces are drawn. If unknown, leave it empty.
  std::vector<ContactState> contacts;
  Energy energy{NAN, NAN, NAN};  ///< NaN: unknown. The page displays the sum of all robots.
};

/// Returns the present state of a world of a batch, without set points.
RobotMoment MomentOf(const WorldBatch& batch, int world);

/// Web server with the viewer's page for one or more robots.
class Page {
 public:
  /// Starts the server. Returns null with diagnostics if this fails: port in use, invalid address,
  /// files of the viewer not found, options out of range.
  static std::unique_ptr<Page> Open(const PageOptions& options, Diagnostics& out);
  ~Page();  ///< Browsers report that the program has ended.
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  /// Return the page's addresses, each with a secret token: `url` permits pausing and seeking,
  /// `watch_url` only watching.
  const std::string& url() const noexcept;
  const std::string& watch_url() const noexcept;

  /// Adds a robot, displaced by `at_m`, and returns its number. The page displays the terrain of
  /// the first robot and, of further robots, terrain that differs from it. `name` becomes the
  /// prefix of the names of its bodies, cables and nodes ("left/rod_0"); it may be empty for one
  /// robot. The page restarts: it discards its history.
  int Add(const ModelDef& robot, const std::string& name = "", const Vec3& at_m = {});

  /// Sets the state of a robot for the next `Show`. A robot without a state is displayed as
  /// described. The first `Show` after an `Add` determines which cables have set points. An unknown
  /// robot, an unknown world of the batch, or lists of wrong length print a line on stderr and
  /// abort the program with abort().
  void Set(int robot, const WorldBatch& batch, int world = 0);
  void Set(int robot, const RobotMoment& moment);

  /// Sets the value of a custom channel for the next `Show`, such as "reward" or "error/roll_rad".
  /// A channel exists from its first value on; if the page has displayed data before, it restarts
  /// then.
  void Plot(const std::string& channel, const std::string& unit, double value);

  /// Displays the present states with the time `time_s`. Waits according to the speed, or while the
  /// page is paused. A time before the previous call's starts a new run.
  void Show(double time_s);

 private:
  struct Impl;
  explicit Page(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
