/// What all commands with a page in a browser have in common: tokens, and where to open it.
#pragma once

#include <string>

#include "apps/viewer/server.h"

namespace taut::cli {

/// Tokens that the environment names, else the random ones that stand there. False, after a message
/// on stderr, if they are no good.
bool TokensOf(viewer::ServerOptions& options);

/// The two addresses, and what is dangerous about them. `ends`: what Ctrl-C does.
void SayAddresses(const std::string& title, const viewer::ServerOptions& options,
                  std::uint16_t port, const std::string& ends);

/// On the terminal, if there still is one.
void Tell(const std::string& text);

}  // namespace taut::cli
