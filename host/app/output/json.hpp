// Results for scripts: one JSON object on standard output, where --json was said. Keys are in snake_case
// with the unit in the name (`live_start_ns`), and keep the order in which they were added.
#pragma once

#include <nlohmann/json.hpp>

#include "app/output/console.hpp"
#include "session/capture.hpp"

namespace nutik::app {

using Json = nlohmann::ordered_json;

// `width`, `height`, `channels`.
inline void add_shape(Json& json, const Shape& shape) {
  json["width"] = shape.width;
  json["height"] = shape.height;
  json["channels"] = shape.channels;
}

// Text that is no UTF-8, a file name for example, is shown with U+FFFD in place of its bytes.
inline void print_json(const Json& json) {
  print_line(json.dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace nutik::app
