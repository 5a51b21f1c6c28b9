#include "tests/viewer/client.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstring>

namespace taut::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

namespace {

tcp::endpoint Here(std::uint16_t port) { return {asio::ip::make_address("127.0.0.1"), port}; }

}  // namespace

HttpAnswer Get(std::uint16_t port, const std::string& target,
               const std::vector<std::pair<std::string, std::string>>& fields,
               const std::string& method) {
  asio::io_context io;
  beast::tcp_stream stream(io);
  stream.connect(Here(port));
  http::request<http::empty_body> request{http::string_to_verb(method), target, 11};
  request.set(http::field::host, "localhost:" + std::to_string(port));
  request.set(http::field::cookie, "taut_token_" + std::to_string(port) + "=" + kDriveToken);
  for (const auto& [name, value] : fields) request.set(name, value);
  http::write(stream, request);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  if (method == "HEAD") parser.skip(true);
  http::read(stream, buffer, parser);
  const auto response = parser.release();
  HttpAnswer answer{response.result_int(), response.body(), {}};
  for (const auto& field : response) {
    answer.fields[std::string(field.name_string())] = std::string(field.value());
  }
  return answer;
}

struct HalfOpen::Impl {
  std::uint16_t port = 0;
  asio::io_context io;
  beast::tcp_stream stream{io};
};

HalfOpen::HalfOpen(std::uint16_t port) : impl_(std::make_unique<Impl>()) {
  impl_->port = port;
  impl_->stream.connect(Here(port));
  asio::write(impl_->stream,
              asio::buffer(std::string("GET /?token=" + kDriveToken + " HTTP/1.1\r\n")));
}
HalfOpen::~HalfOpen() = default;

unsigned HalfOpen::End() {
  const std::string rest = "Host: localhost:" + std::to_string(impl_->port) + "\r\n\r\n";
  beast::error_code failed;
  asio::write(impl_->stream, asio::buffer(rest), failed);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(impl_->stream, buffer, response, failed);
  return failed ? 0 : response.result_int();
}

void HalfOpen::AwaitClose() {
  char byte = 0;
  beast::error_code failed;
  impl_->stream.read_some(asio::buffer(&byte, 1), failed);
  EXPECT_TRUE(failed);
}

struct Client::Impl {
  asio::io_context io;
  beast::websocket::stream<beast::tcp_stream> stream{io};
  beast::error_code failed;
  ReceivedFrame frame;
  Json text;

  /// Reads one message into `frame` or `text`. Returns false if the connection has ended.
  bool Read() {
    beast::flat_buffer buffer;
    bool done = false;
    beast::get_lowest_layer(stream).expires_never();
    stream.async_read(buffer, [&](beast::error_code error, std::size_t) {
      failed = error;
      done = true;
    });
    io.restart();
    while (!done) io.run_one();
    if (failed) return false;
    const std::string bytes = beast::buffers_to_string(buffer.data());
    frame.numbers.clear();
    if (stream.got_binary()) {
      frame.numbers.resize(bytes.size() / sizeof(double));
      std::memcpy(frame.numbers.data(), bytes.data(), bytes.size());
    } else {
      text = Json::parse(bytes);
    }
    return true;
  }
};

Client::Client(std::uint16_t port, const std::string& target, const std::string& origin)
    : impl_(std::make_unique<Impl>()) {
  auto& stream = impl_->stream;
  beast::get_lowest_layer(stream).connect(Here(port));
  stream.set_option(
      beast::websocket::stream_base::decorator([origin](beast::websocket::request_type& request) {
        if (!origin.empty()) request.set(http::field::origin, origin);
      }));
  stream.read_message_max(64 << 20);
  stream.handshake("localhost:" + std::to_string(port), target, impl_->failed);
}
Client::~Client() = default;

bool Client::failed() const { return static_cast<bool>(impl_->failed); }

void Client::SendText(const std::string& text) {
  impl_->stream.text(true);
  impl_->stream.write(asio::buffer(text), impl_->failed);
}

void Client::SendBinary(const std::string& bytes) {
  impl_->stream.binary(true);
  impl_->stream.write(asio::buffer(bytes), impl_->failed);
}

void Client::SendRaw(const std::string& bytes) {
  asio::write(beast::get_lowest_layer(impl_->stream).socket(), asio::buffer(bytes), impl_->failed);
}

Json Client::AwaitText(const std::function<bool(const Json&)>& wanted) {
  while (impl_->Read()) {
    if (impl_->frame.numbers.empty() && wanted(impl_->text)) return impl_->text;
  }
  return nullptr;
}

ReceivedFrame Client::AwaitFrame(const std::function<bool(const ReceivedFrame&)>& wanted) {
  while (impl_->Read()) {
    if (!impl_->frame.numbers.empty() && wanted(impl_->frame)) return impl_->frame;
  }
  return {};
}

CloseReason Client::AwaitClose() {
  while (impl_->Read()) {
  }
  const auto& reason = impl_->stream.reason();
  return {reason.code, std::string(reason.reason.c_str())};
}

void Client::Close() { impl_->stream.close(beast::websocket::close_code::normal, impl_->failed); }

}  // namespace taut::test
