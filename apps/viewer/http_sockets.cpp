#include "http_sockets.h"

#include <optional>
#include <utility>

namespace taut::viewer {
namespace {

constexpr std::uint32_t kMaxHeaderBytes = 8 * 1024;

}  // namespace

class HttpSockets::Socket : public std::enable_shared_from_this<Socket> {
 public:
  Socket(tcp::socket socket, HttpSockets& all) : stream_(std::move(socket)), all_(all) {}

  void Join(List& list) {
    list_ = &list;
    place_ = list.insert(list.end(), shared_from_this());
  }

  void Read() {
    MoveTo(all_.asking_);
    parser_.emplace();
    parser_->header_limit(kMaxHeaderBytes);
    parser_->body_limit(0);
    stream_.expires_after(all_.options_.request_patience);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code failed, std::size_t) {
                       failed ? self->Close() : self->Answer(self->parser_->release());
                     });
  }

  void Close() {
    if (list_ == nullptr) return;
    const auto self = shared_from_this();
    std::exchange(list_, nullptr)->erase(place_);
    stream_.close();
  }

 private:
  void Answer(const HttpRequest& request) {
    if (list_ == nullptr) return;  // the socket was dropped while the request was arriving
    MoveTo(all_.answered_);
    response_ = all_.serve_(request, stream_);
    if (!response_) return Close();
    serializer_.emplace(*response_);
    stream_.expires_after(all_.options_.answer_patience);
    http::async_write(stream_, *serializer_,
                      [self = shared_from_this()](beast::error_code failed, std::size_t) {
                        if (!failed && self->response_->keep_alive()) return self->Read();
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, failed);
                        self->Close();
                      });
  }

  /// Moves the socket to the end of a list: progress restarts its waiting time.
  void MoveTo(List& list) {
    if (list_ == nullptr) return;
    list.splice(list.end(), *std::exchange(list_, &list), place_);
  }

  beast::tcp_stream stream_;
  HttpSockets& all_;
  List* list_ = nullptr;  ///< List that contains the socket; null: closed.
  List::iterator place_;
  beast::flat_buffer buffer_{64 * 1024};
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::optional<HttpResponse> response_;
  std::optional<http::response_serializer<http::string_body>> serializer_;
};

void HttpSockets::Add(tcp::socket socket) {
  if (asking_.size() + answered_.size() >= options_.max_http) DropOldest();
  const auto added = std::make_shared<Socket>(std::move(socket), *this);
  added->Join(asking_);
  added->Read();
}

void HttpSockets::DropOldest() {
  for (List* list : {&asking_, &answered_}) {
    if (!list->empty()) return list->front()->Close();
  }
}

}  // namespace taut::viewer
