/// What the server answers to plain HTTP.
#pragma once

#include <string>

#include "network.h"
#include "server.h"

namespace taut::viewer {

using HttpRequest = http::request<http::empty_body>;
using HttpResponse = http::response<http::string_body>;

enum class Access { kNone, kWatch, kDrive };

/// What the browser that sends this may do: by the token that it has, if it names this machine and
/// no other site's page is behind it.
Access AccessOf(const HttpRequest& request, const ServerOptions& options);

HttpResponse Refusal(const HttpRequest& request, http::status status, const std::string& text);

/// The file asked for, or what is wrong.
HttpResponse Answer(const HttpRequest& request, const WebFiles& files,
                    const ServerOptions& options);

}  // namespace taut::viewer
