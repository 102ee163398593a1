#include "app/requests/output_words.hpp"

#include "session/error.hpp"
#include "session/format.hpp"

namespace nutik::app {
namespace {

NegativeLight parse_negative_light(const std::string& text) {
  if (text == "saturate") return NegativeLight::saturate;
  if (text == "offset") return NegativeLight::offset;
  if (text == "abs") return NegativeLight::absolute;
  throw UsageError(format("--negative {} is not known; choose saturate, offset or abs", text));
}

}  // namespace

OutputRequest output_request(const Options& options) {
  OutputRequest request;
  if (options.depth) request.depth = parse_depth(*options.depth);
  if (options.negative) request.negative = parse_negative_light(*options.negative);
  return request;
}

}  // namespace nutik::app
