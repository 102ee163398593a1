#include "studio/regions/region_edits.hpp"

#include <algorithm>
#include <optional>

namespace nutik::studio {
namespace {

QString tr(const char* text) { return Document::tr(text); }

Mask mask_of(const Document& document) {
  if (document.state().mask) return (*document.state().mask)->mask;
  const Shape& shape = document.facts()->format.shape;
  return Mask::uniform(shape.width, shape.height, kBackground);
}

void apply_mask(Document& document, Mask mask, const QString& what) {
  DocumentState state = document.state();
  state.mask = Shared(MaskWithRegions(std::move(mask)));
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

// What is not inside and has the tag loses it.
Mask mask_with(const Document& document, const Region& region, std::uint8_t tag) {
  Mask mask = mask_of(document);
  for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    if (region.inside[pixel] != 0) {
      mask.tags[pixel] = tag;
    } else if (mask.tags[pixel] == tag) {
      mask.tags[pixel] = kBackground;
    }
  }
  return mask;
}

}  // namespace

void add_region(Document& document) {
  if (document.facts() == nullptr) return;
  const auto tag = free_tag(document.functions());
  if (!tag) return;
  DocumentState state = document.state();
  state.functions.emplace(*tag, function_over(state.boxcar));
  state.looks[*tag] = {Document::tr("Region %1").arg(state.functions.size() - 1),
                       first_colour(static_cast<std::uint8_t>(state.functions.size() - 1)), true};
  document.apply(std::move(state), tr("Add region"));
  document.select_tag(*tag);
}

void remove_region(Document& document, std::uint8_t tag) {
  if (tag == kBackground || !document.functions().contains(tag)) return;
  DocumentState state = document.state();
  state.functions.erase(tag);
  if (state.mask) {
    Mask mask = (*state.mask)->mask;
    std::ranges::replace(mask.tags, tag, kBackground);
    state.mask = Shared(MaskWithRegions(std::move(mask)));
  }
  document.apply(std::move(state), tr("Remove region"));
}

void set_look(Document& document, std::uint8_t tag, const RegionLook& look, const QString& what) {
  DocumentState state = document.state();
  state.looks[tag] = look;
  document.apply(std::move(state), what);
}

void expose_over_boxcar(Document& document, std::uint8_t tag) {
  const GainFunction function = function_over(document.boxcar());
  document.set_points(tag, {function.points().begin(), function.points().end()},
                      tr("Expose over the interval"));
}

void paint_region(Document& document, const Region& region, std::uint8_t tag, const QString& what) {
  Mask mask = mask_of(document);
  paint(mask, region, tag);
  apply_mask(document, std::move(mask), what);
}

Region region_of(const Document& document, std::uint8_t tag) {
  const Mask mask = mask_of(document);
  Region region = Region::none(mask.width, mask.height);
  std::ranges::transform(mask.tags, region.inside.begin(),
                         [&](std::uint8_t of) { return static_cast<std::uint8_t>(of == tag); });
  return region;
}

void grow_region(Document& document, std::uint8_t tag, double radius) {
  if (document.facts() == nullptr || tag == kBackground) return;
  const Region region = region_of(document, tag);
  apply_mask(document, mask_with(document, radius < 0 ? shrunk(region, -radius) : grown(region, radius), tag),
             radius < 0 ? tr("Shrink region") : tr("Grow region"));
}

void smooth_region(Document& document, std::uint8_t tag, double radius) {
  if (document.facts() == nullptr || tag == kBackground) return;
  apply_mask(document, mask_with(document, smoothed(region_of(document, tag), radius), tag),
             tr("Smooth region"));
}

void set_feather(Document& document, int feather) {
  DocumentState state = document.state();
  state.feather = feather;
  document.apply(std::move(state), tr("Feather"));
}

}  // namespace nutik::studio
