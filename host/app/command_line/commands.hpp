// The commands. Each returns the exit status; errors are thrown.
#pragma once

#include "session/schema/options.hpp"

namespace nutik::app {

using Run = int(const Options& options);

Run run_activity, run_again, run_batch, run_check, run_completion, run_contact, run_devices, run_encode,
    run_expose, run_info, run_join, run_man, run_mask, run_noise, run_plate, run_recover, run_retime, run_series, run_shutter,
    run_solve, run_study, run_sweep, run_thumbnail, run_trace, run_validate, run_video;

}  // namespace nutik::app
