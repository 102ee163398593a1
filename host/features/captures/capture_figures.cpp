#include "features/captures/capture_figures.hpp"

#include <algorithm>
#include <numeric>

#include "imev/block.hpp"

namespace nutik {

std::uint64_t CaptureFigures::tile_count() const {
  return std::accumulate(tiles.begin(), tiles.end(), std::uint64_t{0});
}

CaptureFigures figures_of(tik::Reader& reader) {
  const CaptureFormat& capture = reader.format();
  CaptureFigures figures;
  figures.is_record_count_exact = capture.shape.width % kTileSide == 0 && capture.shape.height % kTileSide == 0;
  for (std::uint64_t block = 0; block < reader.block_count(); ++block) {
    const BlockGeometry geometry(capture, reader.block_extent(block).sample_count);
    try {
      for (const TileEntry& entry : reader.directory(block)) {
        ++figures.tiles[static_cast<std::size_t>(geometry.kind_of(entry))];
      }
    } catch (const InputError& error) {
      figures.damage.push_back(error);
    }
    figures.payload_bytes += reader.index()[block].payload_bytes;
    figures.record_count += std::min(reader.index()[block].record_count,
                                     capture.shape.pixel_count() * (geometry.sample_count - std::uint64_t{1}));
  }
  const auto& camera = capture.noise.camera;  // whose codes may be narrower than what is held of them
  const std::uint64_t sample_bytes =
      camera ? capture.shape.value_count() * (camera->white_code > 255 ? 2 : 1) : capture.sample_bytes();
  figures.raw_bytes = sample_bytes * reader.timeline().sample_count();
  return figures;
}

}  // namespace nutik
