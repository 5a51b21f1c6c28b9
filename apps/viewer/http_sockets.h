/// Sockets that speak plain HTTP, each until it closes or becomes a WebSocket. There is a limit to
/// them, and requests that never end do not lock others out: they are dropped for new ones.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <utility>

#include "http_page.h"

namespace taut::viewer {

class HttpSockets {
 public:
  /// Answers a request, or takes its socket over: then there is no answer.
  using Serve = std::function<std::optional<HttpResponse>(const HttpRequest&, beast::tcp_stream&)>;

  HttpSockets(const ServerOptions& options, Serve serve)
      : options_(options), serve_(std::move(serve)) {}

  void Add(tcp::socket socket);
  /// Closes the one whose request is the longest unfinished; if all are being answered, the one
  /// that takes the longest. Nothing if there is none.
  void DropOldest();

 private:
  class Socket;
  using List = std::list<std::shared_ptr<Socket>>;

  const ServerOptions& options_;
  Serve serve_;
  List asking_, answered_;  ///< Those that have waited longest come first.
};

}  // namespace taut::viewer
