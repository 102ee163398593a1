#include "media/videos/filters.hpp"

extern "C" __attribute__((visibility("default"))) const nutik::videos::FilterModule nutik_filter_module{
    nutik::use_shared_state,  avfilter_graph_alloc,   avfilter_graph_free,
    avfilter_graph_parse2,    avfilter_graph_config,  avfilter_graph_get_filter,
    av_buffersrc_add_frame,   av_buffersink_get_frame, av_buffersink_get_format,
    av_buffersink_get_time_base};

extern "C" __attribute__((visibility("default"))) const char nutik_module_version[] = NUTIK_VERSION;
