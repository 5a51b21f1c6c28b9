/// HTTP and WebSocket for one session and any number of browsers. Everything here runs on the
/// thread that calls Run; the session has its own.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "session.h"

namespace taut::viewer {

/// Files by the path that a browser asks for: "/index.html", "/assets/index.js".
using WebFiles = std::map<std::string, std::string>;

/// 32 hexadecimal digits that nobody can guess.
std::string RandomToken();

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0: any that is free.
  /// Browsers must show one of them, in the URL or as the cookie that the URL gave them. With the
  /// first they may drive, with the second look.
  std::string drive_token = RandomToken(), watch_token = RandomToken();

  /// Whether SIGINT, SIGTERM and SIGHUP end it; else they are somebody else's.
  bool ends_on_signals = true;

  /// Sockets of plain HTTP, of which a browser opens six. Where there are as many, a new one takes
  /// the place of the one whose request is the longest unfinished.
  std::size_t max_http = 256;
  /// How long a request, and the next on its socket, may take to come, and an answer to go.
  std::chrono::milliseconds request_patience{10'000}, answer_patience{60'000};
  /// Unread text at which the connection of a page is closed: the page is gone or too slow. Frames
  /// do not count, since only the newest one waits.
  std::size_t max_unread_bytes = 64 << 20;
};

class Server {
 public:
  Server(Session& session, WebFiles files, const ServerOptions& options);
  ~Server();

  /// Binds the port; from here on signals end `Run`, also one that comes before it. False: `error`
  /// says which port is in use and which is free, or what else is wrong.
  bool Listen(std::string& error);
  std::uint16_t port() const;  ///< Bound to.

  /// Serves until Stop or a signal; then has stopped the session. The next such signal ends the
  /// program.
  void Run();
  void Stop();  ///< From any thread.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What to open in a browser for what a token allows.
std::string Url(const ServerOptions& options, std::uint16_t port, const std::string& token);

/// Whether it is the number of one, as 127.0.0.1 or ::1.
bool IsAddress(const std::string& address);

/// Whether only programs of this machine can reach the address.
bool IsLoopback(const std::string& address);

}  // namespace taut::viewer
