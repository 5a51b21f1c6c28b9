/// What the server answers to plain HTTP.
#pragma once

#include <string>

#include "network.h"
#include "server.h"

namespace taut::viewer {

using HttpRequest = http::request<http::empty_body>;
using HttpResponse = http::response<http::string_body>;

/// Whether the browser that sends this may talk to us: it has the token, it names this machine, and
/// no other site's page is behind it.
bool MayEnter(const HttpRequest& request, const ServerOptions& options);

/// The file asked for, or what is wrong.
HttpResponse Answer(const HttpRequest& request, const WebFiles& files,
                    const ServerOptions& options);

}  // namespace taut::viewer
