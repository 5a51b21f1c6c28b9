/// Sockets for plain HTTP, until they close or become WebSockets. Their number is limited: a new
/// socket replaces the one with the longest unfinished request, so that none is blocked for long.
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
  /// Answers a request, or takes over its socket and returns nothing.
  using Serve = std::function<std::optional<HttpResponse>(const HttpRequest&, beast::tcp_stream&)>;

  HttpSockets(const ServerOptions& options, Serve serve)
      : options_(options), serve_(std::move(serve)) {}

  void Add(tcp::socket socket);
  /// Closes the socket with the longest unfinished request; if all requests are being answered, the
  /// one with the longest answer. No effect without sockets.
  void DropOldest();

 private:
  class Socket;
  using List = std::list<std::shared_ptr<Socket>>;

  const ServerOptions& options_;
  Serve serve_;
  List asking_, answered_;  ///< The longest waiting socket is first.
};

}  // namespace taut::viewer
