/// A client of the viewer without a browser: HTTP and a WebSocket over a real socket. Waits have no
/// time limit; ctest ends a test whose answer never comes. Only client.cpp uses Boost, which takes
/// long to compile.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/protocol_messages.h"

namespace taut::test {

using Json = nlohmann::json;

/// Tokens of every server in the tests
inline const std::string kDriveToken = "drive-drive-drive", kWatchToken = "watch-watch-watch";
inline const std::string kToDrive = "/ws?token=" + kDriveToken,
                         kToWatch = "/ws?token=" + kWatchToken;

struct HttpAnswer {
  unsigned status = 0;
  std::string body;
  std::map<std::string, std::string> fields;
};

/// Requests a page, with the cookie of a client that may drive unless `fields` contains another.
/// Throws a std::runtime_error if the connection ends before the answer.
HttpAnswer Get(std::uint16_t port, const std::string& target,
               const std::vector<std::pair<std::string, std::string>>& fields = {},
               const std::string& method = "GET");

/// A request that is begun and not completed
class HalfOpen {
 public:
  explicit HalfOpen(std::uint16_t port);
  ~HalfOpen();
  /// Returns the status of the answer after sending the rest of the request; 0: the server has
  /// closed the connection.
  unsigned End();
  /// Waits until the server closes the connection.
  void AwaitClose();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

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

/// Reason for which a WebSocket was closed. Codes: RFC 6455, section 7.4.1.
struct CloseReason {
  int code = 0;
  std::string reason;
};
inline constexpr int kPolicyViolation = 1008, kMessageTooBig = 1009;

class Client {
 public:
  explicit Client(std::uint16_t port, const std::string& target = kToDrive,
                  const std::string& origin = "");
  ~Client();

  bool open() const { return !failed(); }
  bool failed() const;

  void Send(const Json& message) { SendText(message.dump()); }
  void SendText(const std::string& text);
  void SendBinary(const std::string& bytes);
  void SendRaw(const std::string& bytes);

  /// Reads until a text of this type comes; a null if the connection ends before.
  Json Await(const std::string& type) {
    return AwaitText([&](const Json& message) { return message["type"] == type; });
  }
  Json AwaitText(const std::function<bool(const Json&)>& wanted);
  /// Reads until a frame fulfills `wanted`; an empty frame if the connection ends before.
  ReceivedFrame AwaitFrame(const std::function<bool(const ReceivedFrame&)>& wanted =
                               [](const auto&) { return true; });
  /// Reads until the connection ends. Returns the reason of closing.
  CloseReason AwaitClose();
  void Close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut::test
