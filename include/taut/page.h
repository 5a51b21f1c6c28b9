/// A page of a program's own: opens the viewer in a browser and shows in it what the program says,
/// robots that taut simulates and others.
///
///     taut::Diagnostics out;
///     const auto page = taut::Page::Open({}, out);      // page->url() is to be opened
///     const int robot = page->Add(model->def());
///     for (...) {
///       batch.Step(step_s);
///       page->Set(robot, batch);
///       page->Show(batch.Time(0));
///     }
///
/// Whoever looks can pause, slow down, look back and plot, as with a live run (docs/viewer.md). SI
/// units; world frame W as in taut/model_def.h.
///
/// Threads: the functions of one page must not be called from two threads at once. The server has
/// threads of its own.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "taut/batch.h"
#include "taut/diagnostics.h"

namespace taut {

struct PageOptions {
  std::string title = "taut";
  /// Simulated seconds a second that `Show` keeps to, > 0; 0: it does not wait. Browsers may change
  /// it.
  double speed = 1;
  std::string address = "127.0.0.1";  ///< To listen on; this one: for this machine only.
  std::uint16_t port = 0;             ///< 0: any that is free.
  /// Folder of the viewer's pages, where neither $TAUT_WEB nor a folder beside the program has
  /// them.
#ifdef TAUT_WEB_FOLDER  // said by the CMake target
  std::string web_folder = TAUT_WEB_FOLDER;
#else
  std::string web_folder;
#endif
  double history_period_s = 0.01;  ///< Simulated time between the moments kept to look back, > 0.
};

/// What a robot is like. Lists are as long as those of its `ModelDef`; an empty one is not known.
struct RobotMoment {
  std::vector<BodyState> bodies;  ///< Velocities are not shown.
  std::vector<double> tension_n, length_m, rest_length_m, set_point_n;  ///< By cable.
  /// By cable: where it is bent, along it, in W; of those alone that touch what they come to.
  std::vector<std::vector<Vec3>> bends_m;
  /// By cable: of its spans, along it; of those alone that have friction.
  std::vector<std::vector<double>> span_tension_n;
  std::vector<Vec3> node_force_n;  ///< By node, in W: what pushes from outside.
  /// Of any length; points and forces are drawn. Where it is not known, it is as if there were
  /// none.
  std::vector<ContactState> contacts;
  Energy energy{NAN, NAN, NAN};  ///< Not a number: not known. The page shows the sum of all robots.
};

/// A world of a batch at this moment; nothing of set points.
RobotMoment MomentOf(const Batch& batch, int world);

class Page {
 public:
  /// Starts to serve. Nothing and diagnostics if it cannot: the port is in use, an address that is
  /// none, no pages, options out of their ranges.
  static std::unique_ptr<Page> Open(const PageOptions& options, Diagnostics& out);
  ~Page();  ///< Browsers say that the program has gone.
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  /// The addresses, each with a secret token, for those who may pause and seek and for those who
  /// may only look.
  const std::string& url() const noexcept;
  const std::string& watch_url() const noexcept;

  /// A robot more, `at_m` away from where it says it is; its number. The first one's terrain is
  /// shown, and of later ones what is not the same. `name` goes before the names of its
  /// bodies, cables and nodes ("left/rod_0"); it may be empty for one robot. The page begins anew:
  /// what was shown before is forgotten.
  int Add(const ModelDef& robot, const std::string& name = "", const Vec3& at_m = {});

  /// What the next `Show` shows. Set points count from the first `Show` after an `Add` or not at
  /// all, as to whether there are any. A robot that is never set stands as described. A number that
  /// is no robot's, a world that the batch does not have, or lists of other lengths than the
  /// robot's: a line on stderr, and the program ends by abort().
  void Set(int robot, const Batch& batch, int world = 0);
  void Set(int robot, const RobotMoment& moment);

  /// A channel of the program's own, of what the next `Show` shows: "reward", "error/roll_rad". It
  /// is there from its first value on; a page that has shown something begins anew with it.
  void Plot(const std::string& channel, const std::string& unit, double value);

  /// Shows it as of a time, and waits as long as the speed asks for, or the page is paused. A time
  /// before that of the last call begins a run anew.
  void Show(double time_s);

 private:
  struct Impl;
  explicit Page(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
