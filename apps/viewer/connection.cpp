#include "connection.h"

#include <utility>

#include "command.h"

namespace taut::viewer {

Connection::Connection(tcp::socket socket, int client, bool may_drive, std::size_t max_unread_bytes,
                       Handlers handlers)
    : stream_(std::move(socket)),
      client_(client),
      may_drive_(may_drive),
      max_unread_bytes_(max_unread_bytes),
      handlers_(std::move(handlers)) {}

void Connection::Accept(const http::request<http::empty_body>& request) {
  beast::get_lowest_layer(stream_).expires_never();
  stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
  stream_.read_message_max(kMaxMessageBytes);
  stream_.async_accept(request, [self = shared_from_this()](beast::error_code failed) {
    if (failed) return self->Finished();
    self->open_ = true;
    self->handlers_.opened(*self);
    self->Read();
  });
}

void Connection::Read() {
  stream_.async_read(received_, [self = shared_from_this()](beast::error_code failed, std::size_t) {
    // A message above the size limit closes the connection automatically, with the corresponding
    // code.
    if (failed || self->closing_) return self->Finished();
    const std::string text = beast::buffers_to_string(self->received_.data());
    self->received_.consume(self->received_.size());
    std::string reason = "messages must be text frames";
    if (!self->stream_.got_text() || !self->handlers_.received(*self, text, reason)) {
      self->Close(reason);
    }
    self->Read();
  });
}

void Connection::SendText(std::string text) {
  if (!open_ || closing_) return;
  waiting_bytes_ += text.size();
  if (waiting_bytes_ > max_unread_bytes_) return Close("too slow");
  texts_.push_back(std::move(text));
  Write();
}

void Connection::SendFrame(std::shared_ptr<const std::string> frame) {
  if (!open_ || closing_) return;
  frame_ = std::move(frame);  // replaces a frame that has not been sent yet
  Write();
}

void Connection::SendStatus(std::shared_ptr<const std::string> text) {
  if (!open_ || closing_ || text == said_status_) return;
  status_ = said_status_ = std::move(text);
  Write();
}

void Connection::Close(const std::string& reason) {
  if (closing_) return;
  closing_ = true;
  close_reason_ = reason.substr(0, 120);  // a close frame has room for 123 bytes
  texts_.clear();
  frame_.reset();
  status_.reset();
  Write();
}

void Connection::Write() {
  if (writing_ || finished_) return;
  const auto written = [self = shared_from_this()](beast::error_code failed, std::size_t) {
    self->writing_ = false;
    if (failed) return self->Finished();
    self->Write();
  };
  if (closing_) {
    writing_ = true;
    stream_.async_close({websocket::close_code::policy_error, close_reason_},
                        [self = shared_from_this()](beast::error_code) { self->Finished(); });
  } else if (!texts_.empty()) {
    writing_ = true;
    sending_text_ = std::move(texts_.front());
    texts_.pop_front();
    waiting_bytes_ -= sending_text_.size();
    stream_.text(true);
    stream_.async_write(asio::buffer(sending_text_), written);
  } else if (status_) {
    writing_ = true;
    sending_ = std::move(status_);
    status_.reset();
    stream_.text(true);
    stream_.async_write(asio::buffer(*sending_), written);
  } else if (frame_) {
    writing_ = true;
    sending_ = std::move(frame_);
    frame_.reset();
    stream_.binary(true);
    stream_.async_write(asio::buffer(*sending_), written);
  }
}

void Connection::Finished() {
  if (std::exchange(finished_, true)) return;
  beast::error_code ignored;
  beast::get_lowest_layer(stream_).socket().close(ignored);
  if (std::exchange(open_, false)) handlers_.closed(*this);
}

}  // namespace taut::viewer
