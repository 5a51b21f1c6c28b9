/// HTTP and WebSocket server for one session and any number of browsers. All its work runs on the
/// thread that calls Run; the session has a separate thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "session.h"

namespace taut::viewer {

/// Files by request path: "/index.html", "/assets/index.js".
using WebFiles = std::map<std::string, std::string>;

/// Returns 32 random hexadecimal digits, from a cryptographic generator.
std::string RandomToken();

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;  ///< Port to listen on; 0: any free port.
  /// Browsers must present one of the tokens, in the URL or as the cookie set with it. The first
  /// permits driving, the second only watching.
  std::string drive_token = RandomToken(), watch_token = RandomToken();

  /// Whether SIGINT, SIGTERM and SIGHUP end the server; otherwise the program handles them.
  bool ends_on_signals = true;

  /// Value of the directive frame-ancestors of Content-Security-Policy: origins of other pages that
  /// may contain this one in a frame.
  std::string frame_ancestors = "'none'";

  /// Limit of plain HTTP sockets (a browser opens six). Above the limit, a new socket replaces the
  /// one with the longest unfinished request.
  std::size_t max_http = 256;
  /// Timeouts for receiving a request (also the next on its socket) and for sending an answer.
  std::chrono::milliseconds request_patience{10'000}, answer_patience{60'000};
  /// Amount of unsent text at which a connection is closed, because its page does not read or is
  /// too slow. Frames do not count, since only the newest one waits.
  std::size_t max_unread_bytes = 64 << 20;
};

class Server {
 public:
  Server(Session& session, WebFiles files, const ServerOptions& options);
  ~Server();

  /// Binds the port. After this call, signals end `Run`, even if they arrive before it starts.
  /// Returns false if the port is in use (`error` contains a free one) or on another error.
  bool Listen(std::string& error);
  std::uint16_t port() const;  ///< The bound port.

  /// Serves until Stop or a signal, then stops the session and returns. A second signal ends the
  /// program.
  void Run();
  void Stop();  ///< Thread-safe.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns the URL with a token.
std::string Url(const ServerOptions& options, std::uint16_t port, const std::string& token);

/// Returns the URL with a numeric address instead of the name of this machine, for devices that
/// cannot resolve the name, such as phones.
std::string NumericUrl(const ServerOptions& options, std::uint16_t port, const std::string& token);

/// Returns whether the text is a numeric address, such as 127.0.0.1 or ::1.
bool IsAddress(const std::string& address);

/// Returns whether only programs on this machine can reach the address.
bool IsLoopback(const std::string& address);

}  // namespace taut::viewer
