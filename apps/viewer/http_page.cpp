#include "http_page.h"

#include <fmt/format.h>

#include <string_view>

namespace taut::viewer {
namespace {

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

/// Returns the value of `name` in "a=1&b=2" or "a=1; b=2"; empty if it is missing.
std::string_view ValueOf(std::string_view list, std::string_view name, char separator) {
  while (!list.empty()) {
    const std::size_t end = list.find(separator);
    std::string_view one = list.substr(0, end);
    list = end == list.npos ? std::string_view() : list.substr(end + 1);
    while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
    if (one.size() > name.size() && one.substr(0, name.size()) == name && one[name.size()] == '=') {
      return one.substr(name.size() + 1);
    }
  }
  return {};
}

/// Compares in constant time, so that the duration does not reveal how much of a guess is right.
bool SameSecret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |=
        static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  }
  return difference == 0;
}

std::string_view Query(const HttpRequest& request) {
  const std::string_view target = View(request.target());
  const std::size_t mark = target.find('?');
  return mark == target.npos ? std::string_view() : target.substr(mark + 1);
}

/// Returns "localhost" for "localhost:8080", "[::1]" for "[::1]:8080".
std::string_view HostName(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const std::size_t bracket = host.rfind(']');
  if (colon == host.npos || (bracket != host.npos && colon < bracket)) return host;
  return host.substr(0, colon);
}

std::string_view MimeType(std::string_view path) {
  static constexpr std::pair<std::string_view, std::string_view> kTypes[] = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"}};
  for (const auto& [end, type] : kTypes) {
    if (path.ends_with(end)) return type;
  }
  return "application/octet-stream";
}

Access AccessOf(std::string_view token, const ServerOptions& options) {
  if (SameSecret(token, options.drive_token)) return Access::kDrive;
  return SameSecret(token, options.watch_token) ? Access::kWatch : Access::kNone;
}

/// Returns a name with the port: browsers send a cookie to every port of a machine, so that each
/// server needs a different name.
std::string CookieName(const ServerOptions& options) {
  return fmt::format("taut_token_{}", options.port);
}

/// Returns whether the request addresses this server and comes from its pages.
bool IsOurs(const HttpRequest& request, const ServerOptions& options) {
  const std::string_view host = View(request[http::field::host]);
  // Prevents DNS rebinding: foreign pages reach local servers under a name that resolves to this
  // machine.
  if (IsLoopback(options.address)) {
    const std::string_view name = HostName(host);
    if (name != "localhost" && name != "127.0.0.1" && name != "[::1]" && name != options.address) {
      return false;
    }
  }
  const std::string_view origin = View(request[http::field::origin]);
  if (!origin.empty()) {
    const std::size_t slashes = origin.find("://");
    if (slashes == origin.npos || origin.substr(slashes + 3) != host) return false;
  }
  return true;
}

HttpResponse Begin(const HttpRequest& request) {
  HttpResponse response;
  response.version(request.version());
  response.keep_alive(request.keep_alive());
  response.set(http::field::cache_control, "no-cache");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  return response;
}

void End(const HttpRequest& request, HttpResponse& response) {
  response.content_length(response.body().size());
  if (request.method() == http::verb::head) response.body().clear();
}

}  // namespace

Access AccessOf(const HttpRequest& request, const ServerOptions& options) {
  if (!IsOurs(request, options)) return Access::kNone;
  const Access by_query = AccessOf(ValueOf(Query(request), "token", '&'), options);
  if (by_query != Access::kNone) return by_query;
  return AccessOf(ValueOf(View(request[http::field::cookie]), CookieName(options), ';'), options);
}

HttpResponse Refusal(const HttpRequest& request, http::status status, const std::string& text) {
  HttpResponse response = Begin(request);
  response.result(status);
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.body() = text + "\n";
  End(request, response);
  return response;
}

HttpResponse Answer(const HttpRequest& request, const WebFiles& files,
                    const ServerOptions& options) {
  std::string path(View(request.target()).substr(0, View(request.target()).find('?')));
  if (path == "/") path = "/index.html";
  const Access access = AccessOf(request, options);
  if (access == Access::kNone) {
    return Refusal(request, http::status::forbidden,
                   "Open the complete address that taut printed, with its token.");
  }
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    HttpResponse response = Refusal(request, http::status::method_not_allowed,
                                    "This server supports only GET and HEAD.");
    response.set(http::field::allow, "GET, HEAD");
    return response;
  }
  const auto file = files.find(path);
  if (file == files.end()) {
    return Refusal(request, http::status::not_found, "This page does not exist.");
  }
  HttpResponse response = Begin(request);
  response.result(http::status::ok);
  response.set(http::field::content_type, std::string(MimeType(path)));
  // Nothing is loaded from other sites. The page contains its script inline.
  response.set("Content-Security-Policy",
               "default-src 'self'; script-src 'self' 'unsafe-inline'; img-src 'self' data: "
               "blob:; media-src 'self' blob:; "
               "style-src 'self' 'unsafe-inline'; worker-src 'self' blob:; base-uri 'none'; "
               "form-action 'none'; frame-ancestors " +
                   options.frame_ancestors);
  // The cookie authorizes the page's other requests, and reloads without the query.
  response.set(http::field::set_cookie,
               fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", CookieName(options),
                           access == Access::kDrive ? options.drive_token : options.watch_token));
  response.body() = file->second;
  End(request, response);
  return response;
}

}  // namespace taut::viewer
