#include "io/picture/offscreen_window.h"

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>

#include "geometry/errors.h"

namespace isorim::io::picture {
namespace {

/// VTK draws into a context that is current already.
class CurrentContextWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static CurrentContextWindow* New() {
    auto* window = new CurrentContextWindow;
    window->InitializeObjectBase();
    return window;
  }

  void MakeCurrent() override {}
  bool IsCurrent() override { return true; }

  /// GLEW finds OpenGL's functions first and then misses an X display, which we have no need of: VTK takes that for a
  /// failure. What is really missing shows when the picture is drawn.
  void OpenGLInitContext() override {
    if (Initialized) return;
    const int shown = vtkObject::GetGlobalWarningDisplay();
    vtkObject::GlobalWarningDisplayOff();
    vtkGenericOpenGLRenderWindow::OpenGLInitContext();
    vtkObject::SetGlobalWarningDisplay(shown);
    GlewInitValid = true;
    Initialized = true;
  }

 protected:
  CurrentContextWindow() = default;
};

template <class Function>
Function egl_function(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// Displays that may draw without a screen, the surest first; not initialised.
std::vector<EGLDisplay> candidate_displays() {
  std::vector<EGLDisplay> list;
  const auto platform_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  const auto query_devices = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  if (platform_display != nullptr) {
    list.push_back(platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (platform_display != nullptr && query_devices != nullptr &&
      query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE) {
    for (EGLint i = 0; i < count; ++i) {
      list.push_back(platform_display(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
    }
  }
  list.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return list;
}

/// A context of OpenGL 3.2 without a surface, made current.
class EglContext {
 public:
  EglContext() {
    // Where there is no graphics card Mesa tells so at length before it draws by software.
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    for (EGLDisplay display : candidate_displays()) {
      if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) continue;
      if (make_current(display)) return;
    }
    throw NumericalError(
        "cannot draw: EGL gives no context of OpenGL 3.2; install libegl1 and libgl1-mesa-dri, which draw by software");
  }
  ~EglContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

 private:
  bool make_current(EGLDisplay display) {
    constexpr std::array<EGLint, 5> config_wanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                                  EGL_OPENGL_BIT, EGL_NONE};
    constexpr std::array<EGLint, 7> context_wanted{
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return false;
    if (eglChooseConfig(display, config_wanted.data(), &config, 1, &found) != EGL_TRUE || found < 1) return false;
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_wanted.data());
    if (context == EGL_NO_CONTEXT) return false;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
      eglDestroyContext(display, context);
      return false;
    }
    display_ = display;
    context_ = context;
    return true;
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

struct OffscreenWindow::Parts {
  /// Dies after the window.
  EglContext context;
  vtkNew<CurrentContextWindow> window;
};

OffscreenWindow::OffscreenWindow(int width, int height) : parts_(std::make_unique<Parts>()) {
  CurrentContextWindow* window = parts_->window;
  window->SetReadyForRendering(true);
  window->SetOwnContext(0);
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(width, height);
  window->OpenGLInit();
}

OffscreenWindow::~OffscreenWindow() {
  parts_->window->Finalize();
}

vtkRenderWindow* OffscreenWindow::get() const {
  return parts_->window;
}

}  // namespace isorim::io::picture
