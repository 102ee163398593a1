#include "session/requests/delay_request.hpp"

#include <algorithm>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "session/requests/named_inputs.hpp"

namespace nutik {
namespace {

constexpr std::string_view kTo = "..";

}  // namespace

DelayRequest DelayRequest::parse(std::string_view text, std::string_view what) {
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size()) {
    throw UsageError(
        format("{} '{}' does not say where and by how much; write rows:15ms, columns:0s..0.5s, "
               "radial:-20ms..20ms or, from black to white of a grey picture, map.tif:0s..1s",
               what, text));
  }
  const std::string_view where = text.substr(0, colon), range = text.substr(colon + 1);
  DelayRequest request;
  if (where == "rows") {
    request.course = Course::rows;
  } else if (where == "columns") {
    request.course = Course::columns;
  } else if (where == "radial") {
    request.course = Course::radial;
  } else {
    request.course = Course::picture;
    request.file = where;
  }
  const auto to = range.find(kTo);
  if (to == std::string_view::npos) {
    request.to = StatedTime::parse(range, what, false);
  } else {
    request.from = StatedTime::parse(range.substr(0, to), what, false);
    request.to = StatedTime::parse(range.substr(to + kTo.size()), what, false);
  }
  return request;
}

DelayRequest DelayRequest::of_times(std::uint32_t width, std::uint32_t height,
                                    std::span<const std::int64_t> times_ns) {
  if (times_ns.size() != std::uint64_t{width} * height) {
    throw UsageError(format("there are {} delays for {} x {} pixels; each pixel needs one", times_ns.size(), width,
                            height));
  }
  DelayMap map{width, height, {times_ns.begin(), times_ns.end()}, {}};
  std::ranges::sort(map.delays_ns);
  map.delays_ns.erase(std::unique(map.delays_ns.begin(), map.delays_ns.end()), map.delays_ns.end());
  if (map.delays_ns.size() > DelayMap::kMaxDelays) {
    throw UsageError(format("there are {} different delays, and there can be {}; round them to fewer",
                            map.delays_ns.size(), DelayMap::kMaxDelays));
  }
  map.delay_of_pixel.reserve(times_ns.size());
  for (const std::int64_t time_ns : times_ns) {
    const auto at = std::ranges::lower_bound(map.delays_ns, time_ns);
    map.delay_of_pixel.push_back(static_cast<std::uint16_t>(at - map.delays_ns.begin()));
  }
  DelayRequest request;
  request.course = Course::times;
  request.map = std::make_shared<const DelayMap>(std::move(map));
  return request;
}

std::string DelayRequest::range_text() const { return format("{}{}{}", from.text(), kTo, to.text()); }

void DelayRequest::read() {
  if (course != Course::picture) return;
  try {
    picture = Shared(read_picture(file).codes);
  } catch (const InputError& error) {
    if (file.find('.') != std::string::npos) throw;
    throw UsageError(format("{}; or, without a picture, rows:, columns: or radial:", error.what()));
  }
}

std::pair<std::int64_t, std::int64_t> delay_ends_ns(const std::optional<DelayRequest>& request) {
  if (!request) return {};
  if (request->map) return {request->map->delays_ns.front(), request->map->delays_ns.back()};
  return std::minmax({request->from.nanoseconds(), request->to.nanoseconds()});
}

std::shared_ptr<const DelayMap> delays_of(const DelayRequest& request, const Shape& shape) {
  const DelayRange range{request.from.exact_nanoseconds(), request.to.exact_nanoseconds()};
  const auto shared = [](DelayMap map) { return std::make_shared<const DelayMap>(std::move(map)); };
  switch (request.course) {
    case DelayRequest::Course::rows: return shared(DelayMap::by_rows(shape, range));
    case DelayRequest::Course::columns: return shared(DelayMap::by_columns(shape, range));
    case DelayRequest::Course::radial: return shared(DelayMap::by_radius(shape, range));
    case DelayRequest::Course::times:
      if (request.map->width != shape.width || request.map->height != shape.height) {
        throw InputError(format("the delays are for {} x {} pixels and the pictures are {} x {}",
                                request.map->width, request.map->height, shape.width, shape.height));
      }
      return request.map;
    case DelayRequest::Course::picture: break;
  }
  if (!request.picture) throw UsageError(format("the map of delays {} was not read", request.file));
  const Shape& found = (*request.picture)->shape;
  if (found.width != shape.width || found.height != shape.height) {
    throw InputError(
        format("{} is {} x {} pixels and the pictures are {} x {}; a map of delays needs their size",
               request.file, found.width, found.height, shape.width, shape.height));
  }
  return shared(DelayMap::by_picture(**request.picture, range, request.file));
}

}  // namespace nutik
