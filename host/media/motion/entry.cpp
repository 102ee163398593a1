// What nutik-motion.so gives the program (media/module.hpp).
#include "media/module.hpp"
#include "media/motion/registrar.hpp"

extern "C" __attribute__((visibility("default")))
const nutik::MotionModule nutik_motion_module{nutik::use_shared_state, nutik::motion::open_registrar};

extern "C" __attribute__((visibility("default"))) const char nutik_module_version[] = NUTIK_VERSION;
