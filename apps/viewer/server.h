/// HTTP and WebSocket for one session and any number of browsers. Everything here runs on the
/// thread that calls Run; the session has its own.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "session.h"

namespace taut::viewer {

/// Files by the path that a browser asks for: "/index.html", "/assets/index.js".
using WebFiles = std::map<std::string, std::string>;

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0: any that is free.
  /// Browsers must show it, in the URL or as the cookie that the URL gave them; empty: no token.
  std::string token;
};

class Server {
 public:
  Server(Session& session, WebFiles files, const ServerOptions& options);
  ~Server();

  /// Binds the port. False: `error` says which port is in use and which is free, or what else is
  /// wrong.
  bool Listen(std::string& error);
  std::uint16_t port() const;  ///< Bound to.

  /// Serves until Stop or one of SIGINT, SIGTERM and SIGHUP; then has stopped the session. The next
  /// such signal ends the program.
  void Run();
  void Stop();  ///< From any thread.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether only programs of this machine can reach the address.
bool IsLoopback(const std::string& address);

/// 32 hexadecimal digits that nobody can guess.
std::string RandomToken();

}  // namespace taut::viewer
