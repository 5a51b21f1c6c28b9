/// Long computations that Ctrl-C can end.
#pragma once

#include <atomic>
#include <functional>

namespace taut::python {

/// Runs `work` on a separate thread while other Python threads run; this thread checks for Ctrl-C
/// and calls `look`, with the GIL, a few times per second. If either raises, `stop` becomes true:
/// `work` must return; afterwards the exception is raised. `work` must not use Python objects. The
/// GIL must be held.
void Interruptible(const std::function<void(const std::atomic<bool>& stop)>& work,
                   const std::function<void()>& look = {});

}  // namespace taut::python
