/// Tokens and addresses of commands that serve a page to browsers.
#pragma once

#include <string>

#include "apps/viewer/server.h"

namespace taut::cli {

/// Replaces the random tokens by those in the environment. Returns false, after a message on
/// stderr, if they are invalid.
bool TokensOf(viewer::ServerOptions& options);

/// Prints the two addresses. If other machines can connect, also prints a warning about the risk
/// and, to a terminal, the first address as a QR code. `ends`: effect of Ctrl-C.
void SayAddresses(const std::string& title, const viewer::ServerOptions& options,
                  std::uint16_t port, const std::string& ends);

/// Prints to the terminal, if there still is one.
void Tell(const std::string& text);

}  // namespace taut::cli
