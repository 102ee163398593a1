#include "studio/regions/region_edits.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "exposure/function_text.hpp"
#include "mask/distance.hpp"
#include "studio/regions/covering.hpp"

namespace nutik::studio {
namespace {

void apply(Document& document, Covering covering, const QString& what) {
  DocumentState state = std::move(covering).state();
  state.mode = ExposureMode::functions;
  document.apply(std::move(state), what);
}

// Far from those before in brightness, so that a mask is seen for what it is in any program: 128, 64, 192, 32, …
std::optional<std::uint8_t> free_tag(const FunctionSet& functions) {
  for (unsigned number = 1; number < kMaskValues; ++number) {
    unsigned tag = 0;
    for (unsigned bit = 0; bit < 8; ++bit) tag |= (number >> bit & 1U) << (7U - bit);
    if (!functions.contains(static_cast<std::uint8_t>(tag))) return static_cast<std::uint8_t>(tag);
  }
  return {};
}

GainFunction function_over(const Boxcar& boxcar) {
  return with_steps(GainFunction::boxcar(boxcar.start_ns, boxcar.start_ns + boxcar.length_ns));
}

Region without(Region region, const Region& other) {
  for (std::size_t pixel = 0; pixel < region.inside.size(); ++pixel)
    if (other.inside[pixel] != 0) region.inside[pixel] = 0;
  return region;
}

void replace_area(Document& document, std::uint8_t tag, const Region& area, const QString& what) {
  Covering covering(document);
  const Region before = covering.area_of(tag);
  covering.take(without(before, area), tag);
  covering.give(without(area, before), tag);
  apply(document, std::move(covering), what);
}

}  // namespace

void add_region(Document& document) {
  if (document.facts() == nullptr) return;
  const auto tag = free_tag(document.functions());
  if (!tag) return;
  DocumentState state = document.state();
  state.functions.emplace(*tag, function_over(state.boxcar));
  state.order.insert(state.order.begin(), *tag);
  state.looks[*tag] = {Document::tr("Region %1").arg(state.functions.size() - 1),
                       first_colour(static_cast<std::uint8_t>(state.functions.size() - 1)), true};
  document.apply(std::move(state), Document::tr("Add region"));
  document.select_tag(*tag);
}

void remove_region(Document& document, std::uint8_t tag) {
  if (tag == kBackground || !document.functions().contains(tag)) return;
  Covering covering(document);
  covering.take(covering.area_of(tag), tag);
  DocumentState state = std::move(covering).state();
  state.functions.erase(tag);
  document.apply(std::move(state), Document::tr("Remove region"));
}

void move_region(Document& document, std::uint8_t tag, Move move) {
  const std::vector<std::uint8_t>& order = document.state().order;
  auto place = std::ranges::find(order, tag);
  if (place == order.end()) return;
  if (move == Move::down && ++place == order.end()) return;
  Covering covering(document);
  if (!covering.move_up(*place)) return;
  document.apply(std::move(covering).state(),
                 move == Move::up ? Document::tr("Move region up") : Document::tr("Move region down"));
}

void set_look(Document& document, std::uint8_t tag, const RegionLook& look, const QString& what) {
  DocumentState state = document.state();
  state.looks[tag] = look;
  document.apply(std::move(state), what);
}

void expose_over_boxcar(Document& document, std::uint8_t tag) {
  const GainFunction function = function_over(document.boxcar());
  document.set_points(tag, {function.points().begin(), function.points().end()},
                      Document::tr("Expose over the interval"));
}

void paint_region(Document& document, const Region& region, std::uint8_t tag, const QString& what) {
  Covering covering(document);
  tag == kBackground ? covering.take_from_all(region) : covering.give(region, tag);
  apply(document, std::move(covering), what);
}

void erase_region(Document& document, const Region& region, std::uint8_t tag, const QString& what) {
  Covering covering(document);
  covering.take(region, tag);
  apply(document, std::move(covering), what);
}

Region region_of(const Document& document, std::uint8_t tag) { return Covering(document).area_of(tag); }

void grow_region(Document& document, std::uint8_t tag, double radius) {
  if (document.facts() == nullptr || tag == kBackground) return;
  const Region region = region_of(document, tag);
  replace_area(document, tag, radius < 0 ? shrunk(region, -radius) : grown(region, radius),
               radius < 0 ? Document::tr("Shrink region") : Document::tr("Grow region"));
}

void smooth_region(Document& document, std::uint8_t tag, double radius) {
  if (document.facts() == nullptr || tag == kBackground) return;
  replace_area(document, tag, smoothed(region_of(document, tag), radius), Document::tr("Smooth region"));
}

void set_feather(Document& document, int feather) {
  DocumentState state = document.state();
  state.feather.everywhere_centipixels = feather;
  document.apply(std::move(state), Document::tr("Feather"));
}

void set_feather_of(Document& document, std::uint8_t tag, std::optional<int> feather) {
  DocumentState state = document.state();
  state.feather.of_tag.erase(tag);
  if (feather) state.feather.of_tag[tag] = *feather;
  document.apply(std::move(state), Document::tr("Feather of region"));
}

}  // namespace nutik::studio
