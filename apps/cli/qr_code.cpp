#include "qr_code.h"

#ifdef TAUT_FEATURE_QR
#include <qrcodegen.hpp>

#include <stdexcept>

namespace taut::cli {
namespace {

/// Light margin around the code [modules]. The standard requires 4; phones accept 2, with which the
/// code fits smaller windows.
constexpr int kMargin = 2;

constexpr const char* kBlackOnWhite = "\x1b[38;5;16;48;5;231m";
constexpr const char* kReset = "\x1b[0m";

}  // namespace

bool HasQrCodes() { return true; }

std::string QrCode(const std::string& text) {
  using qrcodegen::QrCode;
  std::string lines;
  try {
    const QrCode code = QrCode::encodeText(text.c_str(), QrCode::Ecc::LOW);
    // A character shows two modules, one above the other, because it is twice as high as wide.
    for (int y = -kMargin; y < code.getSize() + kMargin; y += 2) {
      lines += kBlackOnWhite;
      for (int x = -kMargin; x < code.getSize() + kMargin; ++x) {
        const bool upper = code.getModule(x, y), lower = code.getModule(x, y + 1);
        lines += upper ? (lower ? "█" : "▀") : (lower ? "▄" : " ");
      }
      lines += kReset;
      lines += '\n';
    }
  } catch (const std::length_error&) {
    return {};
  }
  return lines;
}

}  // namespace taut::cli

#else

namespace taut::cli {

bool HasQrCodes() { return false; }

std::string QrCode(const std::string&) { return {}; }

}  // namespace taut::cli
#endif
