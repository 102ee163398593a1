#include "media/mask_reader.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/netpbm.hpp"
#include "media/png_file.hpp"
#include "system/mapped_file.hpp"

namespace nutik {

Picture read_mask(const std::filesystem::path& path) {
  const MappedFile file(path);
  return read_mask(file.bytes(), path.string());
}

Picture read_mask(std::span<const std::byte> bytes, const std::string& name,
                  const CheckMaskSize& check_size) {
  if (is_png(bytes)) return read_grey_png(bytes, name, check_size);
  if (bytes.size() < 2 || bytes[0] != std::byte{'P'}) {
    throw InputError(
        format("{} is neither a PGM nor a PNG; masks are 8-bit grey pictures of these kinds "
               "(JPEG would change their values)",
               name));
  }
  Picture picture = read_netpbm(bytes, name);
  if (picture.shape.channels != 1) {
    throw InputError(format("{} is a picture of {} channels; a mask has 1 (save it as grey, PGM)", name,
                            picture.shape.channels));
  }
  if (picture.type != ValueType::code8) {
    throw InputError(format("{} is a picture of 16 bits (maximum {}); a mask has 8 (maximum 255 or less)",
                            name, picture.white_code));
  }
  return picture;
}

}  // namespace nutik
