/// WebSocket connection of one client. Texts are sent in order; only the newest frame and the
/// newest robot status are sent.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "network_address.h"

namespace taut::viewer {

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  struct Handlers {
    std::function<void(Connection&)> opened;
    /// Handles a text from the client. If it returns false, the connection is closed with the
    /// reason that it sets.
    std::function<bool(Connection&, const std::string&, std::string&)> received;
    std::function<void(Connection&)> closed;
  };

  /// Closes the connection if more than `max_unread_bytes` of unsent texts accumulate.
  Connection(tcp::socket socket, int client, bool may_drive, std::size_t max_unread_bytes,
             Handlers handlers);

  int client() const noexcept { return client_; }
  bool may_drive() const noexcept { return may_drive_; }
  void Accept(const http::request<http::empty_body>& request);
  void SendText(std::string text);
  void SendFrame(std::shared_ptr<const std::string> frame);
  void SendStatus(std::shared_ptr<const std::string> text);
  void Close(const std::string& reason);

 private:
  void Read();
  void Write();
  void Finished();

  beast::websocket::stream<beast::tcp_stream> stream_;
  int client_;
  bool may_drive_;
  std::size_t max_unread_bytes_;
  Handlers handlers_;
  beast::flat_buffer received_;
  std::deque<std::string> texts_;
  std::size_t waiting_bytes_ = 0;
  std::shared_ptr<const std::string> frame_, status_, said_status_, sending_;
  std::string sending_text_, close_reason_;
  bool open_ = false, writing_ = false, closing_ = false, finished_ = false;
};

}  // namespace taut::viewer
