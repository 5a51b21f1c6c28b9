#include "view_server.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "qr_code.h"

namespace taut::cli {
namespace {

/// Replaces the random token by the environment variable, if set. Returns false if it is too easily
/// guessed.
bool TokenOf(const char* variable, std::string& token) {
  const char* named = std::getenv(variable);
  if (named == nullptr || *named == '\0') return true;
  token = named;
  const bool plain = std::all_of(token.begin(), token.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  });
  if (plain && token.size() >= 16 && token.size() <= 128) return true;
  fmt::print(stderr, "error: {} must be 16 to 128 letters, digits, - or _\n", variable);
  return false;
}

}  // namespace

bool TokensOf(viewer::ServerOptions& options) {
  if (!TokenOf("TAUT_TOKEN", options.drive_token) ||
      !TokenOf("TAUT_WATCH_TOKEN", options.watch_token)) {
    return false;
  }
  if (options.drive_token != options.watch_token) return true;
  fmt::print(stderr, "error: TAUT_TOKEN and TAUT_WATCH_TOKEN must differ\n");
  return false;
}

void SayAddresses(const std::string& title, const viewer::ServerOptions& options,
                  std::uint16_t port, const std::string& ends) {
  fmt::print("{}: {}\nWatch only: {}\n{}\n", title, viewer::Url(options, port, options.drive_token),
             viewer::Url(options, port, options.watch_token), ends);
  std::fflush(stdout);
  if (viewer::IsLoopback(options.address)) return;
  if (isatty(STDOUT_FILENO) == 1) {
    const std::string url = viewer::NumericUrl(options, port, options.drive_token);
    const std::string code = QrCode(url);
    if (!code.empty()) fmt::print("{}On a phone: {}\n", code, url);
    std::fflush(stdout);
  }
  Tell(
      fmt::format("warning: other machines can connect, and the connection is not encrypted: "
                  "others on the network can read these addresses, and then drive (to prevent "
                  "this, leave out --listen and connect with ssh -L {0}:localhost:{0} MACHINE)",
                  port));
}

void Tell(const std::string& text) {
  const std::string line = text + "\n";
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace taut::cli
