/// QR codes for the terminal.
#pragma once

#include <string>

namespace taut::cli {

/// Returns whether this build can draw QR codes.
bool HasQrCodes();

/// Returns a QR code (ISO/IEC 18004) of a text as lines for a terminal. Black and white are set by
/// escape sequences, since readers need dark modules on a light ground whatever the terminal's
/// colors. Returns an empty text if the build lacks QR codes or the text is too long for one.
std::string QrCode(const std::string& text);

}  // namespace taut::cli
