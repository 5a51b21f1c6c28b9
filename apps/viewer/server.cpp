#include "server.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <optional>
#include <random>
#include <utility>

#include "connection.h"
#include "drivers.h"
#include "http_page.h"
#include "http_sockets.h"

namespace taut::viewer {
namespace {

/// The separate limit of watchers leaves places for clients that may drive.
constexpr std::size_t kMaxClients = 64, kMaxWatchers = 48;

}  // namespace

struct Server::Impl {
  Impl(Session& the_session, WebFiles the_files, ServerOptions the_options)
      : session(the_session), files(std::move(the_files)), options(std::move(the_options)) {}

  /// Takes over WebSocket requests and answers all other requests.
  std::optional<HttpResponse> Serve(const HttpRequest& request, beast::tcp_stream& stream) {
    const std::string target(request.target().substr(0, request.target().find('?')));
    const Access access = AccessOf(request, options);
    if (!websocket::is_upgrade(request) || target != "/ws" || access == Access::kNone) {
      return Answer(request, files, options);
    }
    if (clients.size() >= (access == Access::kDrive ? kMaxClients : kMaxWatchers)) {
      return Refusal(request, http::status::service_unavailable, "Too many viewers are connected.");
    }
    Open(stream.release_socket(), request, access);
    return std::nullopt;
  }

  void Accept() {
    acceptor.async_accept([this](beast::error_code failed, tcp::socket socket) {
      if (!acceptor.is_open()) return;
      if (!failed) {
        beast::error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        sockets.Add(std::move(socket));
        return Accept();
      }
      // Out of file descriptors, most likely: retry once some are free.
      sockets.DropOldest();
      pause.expires_after(std::chrono::milliseconds(100));
      pause.async_wait([this](beast::error_code) { Accept(); });
    });
  }

  void Open(tcp::socket socket, const HttpRequest& request, Access access) {
    const int client = ++last_client;
    Connection::Handlers handlers;
    handlers.opened = [this](Connection& who) { Opened(who); };
    handlers.received = [this](Connection& who, const std::string& text, std::string& reason) {
      return Received(who, text, reason);
    };
    handlers.closed = [this](Connection& who) { Closed(who); };
    std::make_shared<Connection>(std::move(socket), client, access == Access::kDrive,
                                 options.max_unread_bytes, std::move(handlers))
        ->Accept(request);
  }

  void Opened(Connection& who) {
    clients[who.client()] = who.shared_from_this();
    Json hello = session.Hello(who.client(), drivers.driver());
    if (!who.may_drive()) hello["watch_only"] = true;
    who.SendText(Dump(hello));
    if (std::string scene = session.scene(); !scene.empty()) who.SendText(std::move(scene));
    if (const auto status = session.status()) who.SendStatus(status);
    if (const auto frame = session.frame()) who.SendFrame(frame);
  }

  bool Received(Connection& who, const std::string& text, std::string& reason) {
    std::optional<Command> command = ParseCommand(text, reason);
    if (!command) return false;
    if (!who.may_drive() && command->type != "want_series") {
      who.SendText(Dump(
          {{"type", "error"},
           {"text", "this address is for watching only; taut printed another address to drive"}}));
      return true;
    }
    const int before = drivers.driver();
    if (!drivers.Allow(who.client(), command->type)) {
      who.SendText(Dump({{"type", "error"},
                         {"text", fmt::format("viewer {} drives; take control first", before)}}));
      return true;
    }
    TellDriver(before);
    if (command->type == "take_control") return true;
    if (session.Post(who.client(), std::move(*command))) return true;
    reason = "too many messages";
    return false;
  }

  void Closed(Connection& who) {
    clients.erase(who.client());
    const int before = drivers.driver();
    drivers.Leave(who.client());
    // Ends a drag whose client has left.
    if (before == who.client() && session.mode() != "replay") {
      Command drop;
      drop.type = "drop";
      session.Post(who.client(), drop);
    }
    TellDriver(before);
  }

  void TellDriver(int before) {
    if (drivers.driver() == before) return;
    session.SetDriver(drivers.driver());
    ToAll(Dump({{"type", "driver"}, {"id", drivers.driver()}}));
  }

  void ToAll(const std::string& text) {
    for (const auto& [id, client] : Clients()) client->SendText(text);
  }

  /// Returns a copy: sending may close a connection, which removes it from `clients`.
  std::map<int, std::shared_ptr<Connection>> Clients() const { return clients; }

  void EndOnSignals();

  /// Requests a call of `Fetch`. Called on the session's thread.
  void Wake() {
    if (woken.exchange(true)) return;
    asio::post(io, [this] { Fetch(); });
  }

  void Fetch() {
    woken = false;  // cleared before fetching, so that later messages wake the server again
    for (Outgoing& message : session.TakeMessages()) {
      if (message.client == 0) {
        ToAll(message.text);
      } else if (const auto at = clients.find(message.client); at != clients.end()) {
        const auto keep = at->second;
        keep->SendText(std::move(message.text));
      }
    }
    if (const auto status = session.status()) {
      for (const auto& [id, client] : Clients()) client->SendStatus(status);
    }
    if (const auto frame = session.frame()) {
      for (const auto& [id, client] : Clients()) client->SendFrame(frame);
    }
  }

  Session& session;
  const WebFiles files;
  ServerOptions options;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer pause{io};
  asio::signal_set signals{io};
  std::map<int, std::shared_ptr<Connection>> clients;
  Drivers drivers;
  std::atomic<bool> woken{false};
  int last_client = 0;
  HttpSockets sockets{options, [this](const HttpRequest& request, beast::tcp_stream& stream) {
                        return Serve(request, stream);
                      }};
};

Server::Server(Session& session, WebFiles files, const ServerOptions& options)
    : impl_(std::make_unique<Impl>(session, std::move(files), options)) {}

Server::~Server() { impl_->session.Stop(); }

namespace {

bool Bind(tcp::acceptor& acceptor, const tcp::endpoint& where, beast::error_code& failed) {
  failed = {};
  acceptor.open(where.protocol(), failed);
  if (!failed) acceptor.set_option(tcp::acceptor::reuse_address(true), failed);
  if (!failed) acceptor.bind(where, failed);
  if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
  if (!failed) return true;
  beast::error_code ignored;
  acceptor.close(ignored);
  return false;
}

}  // namespace

bool Server::Listen(std::string& error) {
  beast::error_code failed;
  const auto address = asio::ip::make_address(impl_->options.address, failed);
  if (failed) {
    error = fmt::format("\"{}\" is not an address", impl_->options.address);
    return false;
  }
  const std::uint16_t port = impl_->options.port;
  if (Bind(impl_->acceptor, {address, port}, failed)) {
    impl_->options.port = this->port();
    if (impl_->options.ends_on_signals) impl_->EndOnSignals();
    return true;
  }
  if (failed != asio::error::address_in_use) {
    error = fmt::format("cannot listen on {} port {}: {}", impl_->options.address, port,
                        failed.message());
    return false;
  }
  error = fmt::format("port {} is in use", port);
  for (int next = port + 1; next <= 65535 && next <= port + 100; ++next) {
    tcp::acceptor trial(impl_->io);
    if (!Bind(trial, {address, static_cast<std::uint16_t>(next)}, failed)) continue;
    error += fmt::format("; next free port: --port {}", next);
    break;
  }
  return false;
}

std::uint16_t Server::port() const {
  beast::error_code ignored;
  return impl_->acceptor.local_endpoint(ignored).port();
}

void Server::Impl::EndOnSignals() {
  signals.add(SIGINT);
  signals.add(SIGTERM);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) signals.add(SIGHUP);  // with nohup, SIGHUP stays ignored
  signals.async_wait([this](beast::error_code failed, int) {
    if (!failed) io.stop();
  });
}

void Server::Run() {
  impl_->Accept();
  impl_->session.Start([this] { impl_->Wake(); });
  impl_->io.run();
  beast::error_code ignored;
  impl_->signals.clear(ignored);
  impl_->session.Stop();
}

void Server::Stop() {
  asio::post(impl_->io, [this] { impl_->io.stop(); });
}

std::string Url(const ServerOptions& options, std::uint16_t port, const std::string& token) {
  std::string host = "localhost";
  if (options.address != "127.0.0.1" && options.address != "::1") {
    host = options.address;
    char name[256] = {};
    if ((host == "0.0.0.0" || host == "::") && gethostname(name, sizeof(name) - 1) == 0) {
      host = name;
    } else if (host.find(':') != host.npos) {
      host = "[" + host + "]";
    }
  }
  return fmt::format("http://{}:{}/?token={}", host, port, token);
}

std::string NumericUrl(const ServerOptions& options, std::uint16_t port, const std::string& token) {
  ServerOptions numeric = options;
  if (options.address == "0.0.0.0" || options.address == "::") {
    // The kernel chooses the address of the interface that leads to other machines. A UDP socket
    // sends nothing when it connects; 192.0.2.1 is reserved for documents (RFC 5737).
    asio::io_context io;
    asio::ip::udp::socket socket(io);
    beast::error_code failed;
    socket.connect({asio::ip::make_address("192.0.2.1"), 9}, failed);
    const auto local = socket.local_endpoint(failed);
    if (!failed && !local.address().is_unspecified()) numeric.address = local.address().to_string();
  }
  return Url(numeric, port, token);
}

bool IsAddress(const std::string& address) {
  beast::error_code failed;
  asio::ip::make_address(address, failed);
  return !failed;
}

bool IsLoopback(const std::string& address) {
  beast::error_code failed;
  const auto parsed = asio::ip::make_address(address, failed);
  return !failed && parsed.is_loopback();
}

std::string RandomToken() {
  std::random_device device;  // random numbers of the kernel
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", device());
  return token;
}

}  // namespace taut::viewer
