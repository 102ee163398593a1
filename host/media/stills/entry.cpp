// What nutik-stills.so gives the program (media/module.hpp).
#include "media/module.hpp"
#include "media/stills/stills.hpp"

extern "C" __attribute__((visibility("default"))) const nutik::StillModule nutik_still_module{
    nutik::use_shared_state, nutik::stills::open_still_files, nutik::stills::read_exif_times,
    nutik::stills::write_exr, nutik::stills::read_exr_text};

extern "C" __attribute__((visibility("default"))) const char nutik_module_version[] = NUTIK_VERSION;
