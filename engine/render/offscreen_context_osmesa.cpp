#include <GL/osmesa.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/render/offscreen_context.h"

#if defined(__SANITIZE_ADDRESS__)
// Mesa 22.3 leaks a small record of each context's own buffer.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa";
}
#endif

namespace vinerow::render {

namespace {

/// The library stays loaded until the process ends: Mesa and LLVM crash if they are unloaded.
struct OsMesaLibrary {
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaGetProcAddress) get_proc_address = nullptr;
};

Result<OsMesaLibrary> load_library() {
  std::vector<std::string> names = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
  if (const char* name = std::getenv("VINEROW_OSMESA")) names = {name};
  std::string reason;
  for (const std::string& name : names) {
    void* handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
      if (reason.empty()) reason = fmt::format("{} cannot be loaded: {}", name, dlerror());
      continue;
    }
    OsMesaLibrary library;
    const auto find = [&](auto& function, const char* symbol) {
      function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(handle, symbol));
      return function != nullptr;
    };
    if (find(library.create, "OSMesaCreateContextAttribs") &&
        find(library.destroy, "OSMesaDestroyContext") &&
        find(library.make_current, "OSMesaMakeCurrent") &&
        find(library.get_proc_address, "OSMesaGetProcAddress")) {
      return library;
    }
    if (reason.empty()) {
      reason = fmt::format("{} is too old: it has no OSMesaCreateContextAttribs", name);
    }
  }
  return Failure{reason};
}

class OsMesaContext final : public OffscreenContext {
 public:
  OsMesaContext(const OsMesaLibrary& library, OSMesaContext context)
      : library_(library), context_(context) {}
  OsMesaContext(const OsMesaContext&) = delete;
  OsMesaContext& operator=(const OsMesaContext&) = delete;
  ~OsMesaContext() override { library_.destroy(context_); }

  void make_current() override {
    if (!library_.make_current(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSize, kSize)) {
      throw std::runtime_error("OSMesaMakeCurrent failed");
    }
  }
  void* find_function(const char* name) const override {
    return reinterpret_cast<void*>(library_.get_proc_address(name));
  }

 private:
  // Pictures are drawn to a framebuffer object; the context's own buffer only has to exist.
  static constexpr int kSize = 16;
  OsMesaLibrary library_;
  OSMesaContext context_;
  std::array<unsigned char, kSize * kSize * 4> pixels_{};
};

}  // namespace

Result<std::unique_ptr<OffscreenContext>> make_osmesa_context() {
  const Result<OsMesaLibrary> library = load_library();
  if (!library) return Failure{library.reason()};
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  const OSMesaContext context = library->create(attributes, nullptr);
  if (context == nullptr) return Failure{"OSMesa gives no OpenGL 3.3 core context"};
  return std::unique_ptr<OffscreenContext>(std::make_unique<OsMesaContext>(*library, context));
}

}  // namespace vinerow::render
