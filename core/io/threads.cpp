#include "core/io/threads.h"

#include <ImfThreading.h>

namespace aftershade::io {

void set_decoding_threads(int threads) { Imf::setGlobalThreadCount(threads); }

}  // namespace aftershade::io
