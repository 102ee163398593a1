// The commands. Each returns the exit status; errors are thrown.
#pragma once

#include "app/command_line/options.hpp"

namespace nutik::app {

int run_encode(const Options& options);
int run_expose(const Options& options);
int run_info(const Options& options);
int run_devices(const Options& options);
int run_recover(const Options& options);
int run_noise(const Options& options);
int run_batch(const Options& options);
int run_check(const Options& options);
int run_trace(const Options& options);
int run_mask(const Options& options);
int run_contact(const Options& options);
int run_activity(const Options& options);
int run_sweep(const Options& options);
int run_video(const Options& options);
int run_shutter(const Options& options);
int run_again(const Options& options);
int run_validate(const Options& options);
int run_completion(const Options& options);
int run_man(const Options& options);

}  // namespace nutik::app
