/// A client of the viewer without a browser: HTTP and a WebSocket over a real socket. Waits have no
/// time limit; ctest ends a test whose answer never comes.
#pragma once

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/viewer/protocol_messages.h"

namespace taut::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using Json = nlohmann::json;

/// Tokens of every server in the tests
inline const std::string kDriveToken = "drive-drive-drive", kWatchToken = "watch-watch-watch";
inline const std::string kToDrive = "/ws?token=" + kDriveToken,
                         kToWatch = "/ws?token=" + kWatchToken;

struct HttpAnswer {
  unsigned status = 0;
  std::string body;
  http::fields fields;
};

/// Requests a page, with the cookie of a client that may drive unless `fields` contains another.
inline HttpAnswer Get(std::uint16_t port, const std::string& target,
                      const std::vector<std::pair<std::string, std::string>>& fields = {},
                      http::verb method = http::verb::get) {
  asio::io_context io;
  beast::tcp_stream stream(io);
  stream.connect(tcp::endpoint(asio::ip::make_address("127.0.0.1"), port));
  http::request<http::empty_body> request{method, target, 11};
  request.set(http::field::host, "localhost:" + std::to_string(port));
  request.set(http::field::cookie, "taut_token_" + std::to_string(port) + "=" + kDriveToken);
  for (const auto& [name, value] : fields) request.set(name, value);
  http::write(stream, request);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  if (method == http::verb::head) parser.skip(true);
  http::read(stream, buffer, parser);
  auto response = parser.release();
  return {response.result_int(), response.body(), response.base()};
}

/// A received frame, with access by the header generated from messages.json
struct ReceivedFrame {
  std::vector<double> numbers;
  double operator[](viewer::FrameHeader i) const { return numbers.at(i); }
  std::size_t Count(viewer::FrameHeader i) const { return static_cast<std::size_t>((*this)[i]); }
  std::size_t bodies() const { return viewer::kFrameHeaderSize; }
  std::size_t cables() const {
    return bodies() + Count(viewer::kFrameBodyCount) * viewer::kFrameBodiesValues;
  }
  std::size_t contacts() const {
    return cables() + Count(viewer::kFrameCableCount) * viewer::kFrameCablesValues;
  }
  std::size_t pushes() const {
    return contacts() + Count(viewer::kFrameContactRows) * viewer::kFrameContactsValues;
  }
  std::size_t values() const {
    return pushes() + Count(viewer::kFramePushCount) * viewer::kFramePushesValues;
  }
  std::size_t end() const { return values() + Count(viewer::kFrameValueCount); }
};

class Client {
 public:
  explicit Client(std::uint16_t port, const std::string& target = kToDrive,
                  const std::string& origin = "")
      : stream_(io_) {
    beast::get_lowest_layer(stream_).connect(
        tcp::endpoint(asio::ip::make_address("127.0.0.1"), port));
    stream_.set_option(
        beast::websocket::stream_base::decorator([origin](beast::websocket::request_type& request) {
          if (!origin.empty()) request.set(http::field::origin, origin);
        }));
    stream_.read_message_max(64 << 20);
    stream_.handshake("localhost:" + std::to_string(port), target, failed_);
  }

  bool open() const { return !failed_; }

  void Send(const Json& message) { SendText(message.dump()); }
  void SendText(const std::string& text) {
    stream_.text(true);
    stream_.write(asio::buffer(text), failed_);
  }
  void SendBinary(const std::string& bytes) {
    stream_.binary(true);
    stream_.write(asio::buffer(bytes), failed_);
  }
  void SendRaw(const std::string& bytes) {
    asio::write(beast::get_lowest_layer(stream_).socket(), asio::buffer(bytes), failed_);
  }

  /// Reads until a text of this type comes; a null if the connection ends before.
  Json Await(const std::string& type) {
    return AwaitText([&](const Json& message) { return message["type"] == type; });
  }
  Json AwaitText(const std::function<bool(const Json&)>& wanted) {
    while (Read()) {
      if (frame_.numbers.empty() && wanted(text_)) return text_;
    }
    return nullptr;
  }
  /// Reads until a frame fulfills `wanted`; an empty frame if the connection ends before.
  ReceivedFrame AwaitFrame(const std::function<bool(const ReceivedFrame&)>& wanted =
                               [](const auto&) { return true; }) {
    while (Read()) {
      if (!frame_.numbers.empty() && wanted(frame_)) return frame_;
    }
    return {};
  }
  /// Reads until the connection ends. Returns the reason of closing.
  beast::websocket::close_reason AwaitClose() {
    while (Read()) {
    }
    return stream_.reason();
  }
  beast::error_code failed() const { return failed_; }
  void Close() { stream_.close(beast::websocket::close_code::normal, failed_); }

 private:
  bool Read() {
    beast::flat_buffer buffer;
    bool done = false;
    beast::get_lowest_layer(stream_).expires_never();
    stream_.async_read(buffer, [&](beast::error_code failed, std::size_t) {
      failed_ = failed;
      done = true;
    });
    io_.restart();
    while (!done) io_.run_one();
    if (failed_) return false;
    const std::string bytes = beast::buffers_to_string(buffer.data());
    frame_.numbers.clear();
    if (stream_.got_binary()) {
      frame_.numbers.resize(bytes.size() / sizeof(double));
      std::memcpy(frame_.numbers.data(), bytes.data(), bytes.size());
    } else {
      text_ = Json::parse(bytes);
    }
    return true;
  }

  asio::io_context io_;
  beast::websocket::stream<beast::tcp_stream> stream_;
  beast::error_code failed_;
  ReceivedFrame frame_;
  Json text_;
};

}  // namespace taut::test
