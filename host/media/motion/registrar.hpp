// What nutik-motion.so is made of (media/module.hpp).
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "align/registrar.hpp"

namespace nutik::motion {

[[nodiscard]] std::unique_ptr<Registrar> open_registrar(const CaptureFormat& format, CameraMotion motion,
                                                        std::span<const std::byte> reference);

}  // namespace nutik::motion
