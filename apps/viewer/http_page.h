/// Responses to plain HTTP requests.
#pragma once

#include <string>

#include "network_address.h"
#include "server.h"

namespace taut::viewer {

using HttpRequest = http::request<http::empty_body>;
using HttpResponse = http::response<http::string_body>;

enum class Access { kNone, kWatch, kDrive };

/// Returns the rights that the token of a request grants; none if the request addresses another
/// host or comes from another site's page.
Access AccessOf(const HttpRequest& request, const ServerOptions& options);

HttpResponse Refusal(const HttpRequest& request, http::status status, const std::string& text);

/// Returns the requested file, or an error response.
HttpResponse Answer(const HttpRequest& request, const WebFiles& files,
                    const ServerOptions& options);

}  // namespace taut::viewer
