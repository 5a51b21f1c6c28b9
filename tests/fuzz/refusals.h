/// Checks of the messages about a file that was read or refused.
#pragma once

#include <string>

#include "fuzz/fuzz_folder.h"
#include "taut/diagnostics.h"

namespace taut::fuzz {

/// Ends the program unless every message contains a file and a text.
inline void CheckMessages(const Diagnostics& out) {
  for (const auto* list : {&out.items(), &out.warnings()}) {
    for (const Diagnostic& one : *list) {
      Must(!one.at.file.empty() && !one.what.empty(), "a message has a place: " + one.what);
    }
  }
}

/// Ends the program unless a reader returned a value or an error, never both, and every message
/// contains a place.
inline void CheckReading(bool read, const Diagnostics& out) {
  Must(read == out.ok(), "a result or an error: " + out.Format());
  CheckMessages(out);
}

}  // namespace taut::fuzz
