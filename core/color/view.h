#pragma once
#include <OpenColorIO/OpenColorIO.h>

#include <string>

/// Views by name: what DisplayTransform is made of. Both functions throw as its constructor says.
namespace aftershade::color {

namespace ocio = OCIO_NAMESPACE;

struct View {
  std::string name;  ///< in full, for reports
  ocio::ConstCPUProcessorRcPtr processor;
};

/// A view of the built-in configuration; "": sRGB.
View built_in_view(const std::string& name);

/// A view of a configuration file; "": its default.
View view_of_file(const std::string& path, const std::string& name);

}  // namespace aftershade::color
