/// Long work that Ctrl-C ends.
#pragma once

#include <atomic>
#include <functional>

namespace taut::python {

/// Does `work` on a thread of its own, while other Python threads go on and this one looks for
/// Ctrl-C and calls `look`, with the GIL, a few times a second. When either raises, `stop` becomes
/// true: `work` has to end, and what was raised is raised here once it has. `work` touches nothing
/// of Python's. The GIL must be held.
void Interruptible(const std::function<void(const std::atomic<bool>& stop)>& work,
                   const std::function<void()>& look = {});

}  // namespace taut::python
