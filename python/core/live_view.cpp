#include "live_view.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace taut::python {
namespace {

constexpr std::chrono::microseconds kPeriod{16667};

/// All views, for the end of the program; protected by the GIL.
std::vector<std::weak_ptr<LiveView>>& Views() {
  static auto* const views = new std::vector<std::weak_ptr<LiveView>>;  // outlives static variables
  return *views;
}

/// Blocks signals in threads started during its lifetime: Python's main thread must get them, so
/// that Ctrl-C interrupts its waits.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

struct LiveView::Shared {
  void Show(const State& state) {
    page->Set(0, state.moment);
    page->Show(state.time_s);
  }

  void Loop() {
    std::unique_lock lock(mutex);
    State state;
    while (!closing) {
      if (source) {
        const std::uint64_t changes = source->changes();
        if (changes % 2 != 0) {
          source->request();
        } else if (changes != shown_changes && source->read(state)) {
          shown_changes = changes;
          Show(state);
        }
      }
      ends.wait_for(lock, kPeriod, [this] { return closing; });
    }
  }

  std::mutex mutex;
  std::condition_variable ends;
  std::unique_ptr<Page> page;  ///< Null once closed.
  std::optional<Source> source;
  std::uint64_t shown_changes = ~std::uint64_t{0};
  bool closing = false;
  std::thread thread;
  const pid_t pid = getpid();
};

LiveView::LiveView() : shared_(std::make_unique<Shared>()) {}

std::shared_ptr<LiveView> LiveView::Open(const ExperimentSpec& experiment, Source source,
                                         const LiveOptions& options, Diagnostics& out) {
  std::erase_if(Views(), [](const std::weak_ptr<LiveView>& view) { return view.expired(); });
  std::shared_ptr<LiveView> view(new LiveView);
  PageOptions of_page;
  of_page.title = options.title;
  of_page.speed = 0;
  of_page.browser_pauses = false;
  of_page.port = options.port;
  of_page.web_folder = options.web_folder;
  // Notebooks: of Jupyter on this machine, and of Visual Studio Code.
  of_page.frame_ancestors =
      "http://localhost:* http://127.0.0.1:* https://localhost:* https://127.0.0.1:* "
      "vscode-webview:";
  const SignalsBlocked blocked;
  view->shared_->page = Page::Open(of_page, out);
  if (!view->shared_->page) return nullptr;
  view->shared_->page->Add(experiment);
  view->url_ = view->shared_->page->url();
  view->shared_->source = std::move(source);
  view->shared_->thread = std::thread([shared = view->shared_.get()] { shared->Loop(); });
  Views().push_back(view);
  return view;
}

LiveView::~LiveView() {
  if (shared_->pid != getpid()) {
    static_cast<void>(shared_.release());  // its threads do not exist in a forked child
  } else {
    Close();
  }
}

bool LiveView::closed() const {
  if (shared_->pid != getpid()) return true;
  const std::lock_guard lock(shared_->mutex);
  return shared_->closing;
}

void LiveView::Close() {
  if (shared_->pid != getpid()) return;
  std::thread thread;
  std::unique_ptr<Page> page;
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->closing = true;
    thread = std::exchange(shared_->thread, {});
  }
  shared_->ends.notify_all();
  if (thread.joinable()) thread.join();
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->source.reset();
    page = std::move(shared_->page);
  }
}

void LiveView::Take(const State& state) {
  const std::lock_guard lock(shared_->mutex);
  if (!shared_->closing) shared_->Show(state);
}

void LiveView::Detach() {
  if (shared_->pid != getpid()) return;
  const std::lock_guard lock(shared_->mutex);
  // The last state may still wait for its turn.
  State state;
  if (shared_->source && !shared_->closing &&
      shared_->source->changes() != shared_->shown_changes && shared_->source->read(state)) {
    shared_->Show(state);
  }
  shared_->source.reset();
}

void CloseLiveViews() {
  for (const std::weak_ptr<LiveView>& view : Views()) {
    if (const auto open = view.lock()) open->Close();
  }
}

}  // namespace taut::python
