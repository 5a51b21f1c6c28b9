#include "taut/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include "joined_robots.h"
#include "page_session.h"
#include "server.h"
#include "taut/spec.h"
#include "web_files.h"

namespace taut {

RobotMoment MomentOf(const WorldBatch& batch, int world) {
  const ModelDef& def = batch.model().def();
  RobotMoment moment;
  for (int b = 0; b < static_cast<int>(def.bodies.size()); ++b) {
    moment.bodies.push_back(batch.Body(world, b));
  }
  for (int c = 0; c < static_cast<int>(def.cables.size()); ++c) {
    const CableState cable = batch.Cable(world, c);
    moment.tension_n.push_back(cable.tension_n);
    moment.length_m.push_back(cable.length_m);
    moment.rest_length_m.push_back(cable.rest_length_m);
    moment.bends_m.push_back(batch.CableBendPlaces(world, c));
    const bool parted = HasFriction(def.cables[static_cast<std::size_t>(c)]);
    moment.span_tension_n.push_back(parted ? batch.CableSpanTensions(world, c)
                                           : std::vector<double>{});
  }
  for (int n = 0; n < static_cast<int>(def.nodes.size()); ++n) {
    moment.node_force_n.push_back(batch.NodeForce(world, n));
  }
  moment.contacts = batch.Contacts(world);
  moment.energy = batch.TotalEnergy(world);
  return moment;
}

struct Page::Impl {
  struct Value {
    ChannelInfo channel;
    double value;
  };

  Impl(const PageOptions& options, const viewer::ServerOptions& where, viewer::WebFiles files)
      : session(options.title, options.speed, options.history_period_s, options.browser_pauses),
        server(session, std::move(files), where) {}
  ~Impl() {
    server.Stop();
    if (thread.joinable()) thread.join();
  }

  viewer::PageSession session;
  viewer::Server server;
  std::string url, watch_url;
  viewer::JoinedRobots robots;
  std::optional<ExperimentSpec> experiment;  ///< Of the only robot.
  std::vector<Value> values;
  bool begins = true;
  std::thread thread;
};

std::unique_ptr<Page> Page::Open(const PageOptions& options, Diagnostics& out) {
  const auto check = [&](bool good, const std::string& what) {
    if (!good) out.Error("page.bad_option", {}, "PageOptions." + what);
  };
  const auto finite = [](double value) { return std::isfinite(value); };
  check(finite(options.speed) && options.speed >= 0,
        fmt::format("speed must not be negative, got {:g}", options.speed));
  check(options.browser_pauses || options.speed == 0,
        fmt::format("speed must be 0 without browser_pauses, got {:g}", options.speed));
  check(finite(options.history_period_s) && options.history_period_s > 0,
        fmt::format("history_period_s must be positive, got {:g}", options.history_period_s));
  check(viewer::IsAddress(options.address),
        fmt::format(
            "address \"{}\" is not an IP address (expected for example 127.0.0.1, this machine)",
            options.address));
  std::string error;
  const auto web = viewer::FindWebFolder(error, options.web_folder);
  if (!web) out.Error("page.not_made", {}, error);
  if (!out.ok()) return nullptr;

  viewer::ServerOptions where;
  where.address = options.address;
  where.port = options.port;
  where.ends_on_signals = false;
  where.frame_ancestors = options.frame_ancestors;
  auto impl = std::make_unique<Impl>(options, where, viewer::ReadWebFiles(*web));
  if (!impl->server.Listen(error)) {
    out.Error("page.not_made", {}, error);
    return nullptr;
  }
  impl->url = viewer::Url(where, impl->server.port(), where.drive_token);
  impl->watch_url = viewer::Url(where, impl->server.port(), where.watch_token);
  impl->thread = std::thread([server = &impl->server] { server->Run(); });
  return std::unique_ptr<Page>(new Page(std::move(impl)));
}

Page::Page(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Page::~Page() = default;

const std::string& Page::url() const noexcept { return impl_->url; }
const std::string& Page::watch_url() const noexcept { return impl_->watch_url; }

int Page::Add(const ExperimentSpec& experiment) {
  const int robot = Add(experiment.robot.def);
  if (robot == 0) impl_->experiment = experiment;
  return robot;
}

int Page::Add(const ModelDef& robot, const std::string& name, const Vec3& at_m) {
  impl_->begins = true;
  impl_->experiment.reset();
  return impl_->robots.Add(robot, name, at_m);
}

void Page::Set(int robot, const WorldBatch& batch, int world) {
  Set(robot, MomentOf(batch, world));
}

void Page::Set(int robot, const RobotMoment& moment) { impl_->robots.Set(robot, moment); }

void Page::Plot(const std::string& channel, const std::string& unit, double value) {
  const auto is_it = [&](const Impl::Value& other) { return other.channel.name == channel; };
  const auto at = std::find_if(impl_->values.begin(), impl_->values.end(), is_it);
  if (at != impl_->values.end()) {
    at->value = value;
    return;
  }
  impl_->values.push_back({{channel, unit}, value});
  impl_->begins = true;
}

void Page::Show(double time_s) {
  if (std::exchange(impl_->begins, false)) {
    std::vector<ChannelInfo> channels;
    for (const Impl::Value& value : impl_->values) channels.push_back(value.channel);
    ExperimentSpec shown;
    if (impl_->experiment) {
      shown = *impl_->experiment;
    } else {
      shown.robot.def = impl_->robots.def();
    }
    impl_->session.Begin(shown, impl_->robots.HasSetPoint(), channels);
  }
  viewer::Frame frame;
  frame.time_s = time_s;
  impl_->robots.Fill(frame);
  for (const Impl::Value& value : impl_->values) frame.values.push_back(value.value);
  impl_->session.Show(std::move(frame));
}

}  // namespace taut
