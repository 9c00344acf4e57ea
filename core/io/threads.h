#pragma once

namespace aftershade::io {

/// Threads that OpenEXR may use to decode and encode, for the whole process; 0 keeps everything on the calling thread.
void set_decoding_threads(int threads);

}  // namespace aftershade::io
