#include "demo/view/view_window.h"

#define GLFW_INCLUDE_NONE
#include <GL/gl.h>
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstring>

namespace mobil {
namespace {

/// Message of the last error, which GLFW reports only to a callback.
std::string last_complaint;  // NOLINT: GLFW is global itself
void complained(int, const char* line) {
  last_complaint = line;
}

}  // namespace

struct ViewWindow::Parts {
  GLFWwindow* window = nullptr;
  GLuint texture = 0;
  int texture_width = 0, texture_height = 0;

  Parts() = default;
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() {
    if (ImGui::GetCurrentContext() != nullptr) {
      ImGui_ImplOpenGL3_Shutdown();
      ImGui_ImplGlfw_Shutdown();
      ImGui::DestroyContext();
    }
    if (window != nullptr) glfwDestroyWindow(window);
    glfwTerminate();
  }
};

ViewWindow::ViewWindow(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ViewWindow::ViewWindow(ViewWindow&&) noexcept = default;
ViewWindow& ViewWindow::operator=(ViewWindow&&) noexcept = default;
ViewWindow::~ViewWindow() = default;

Result<ViewWindow> ViewWindow::open(const std::string& title, int width, int height, bool hidden) {
  const auto none = [] {
    return fail(
        fmt::format("no window: {}; a display and OpenGL 3 are needed (pictures without one: mobil walk "
                    "--frames, mobil crowd --capture)",
                    last_complaint));
  };
  glfwSetErrorCallback(complained);
  if (glfwInit() != GLFW_TRUE) return none();
  auto parts = std::make_unique<Parts>();
  // Pictures are rendered through EGL, and a thread cannot have an additional GLX context.
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_VISIBLE, hidden ? GLFW_FALSE : GLFW_TRUE);
  parts->window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (parts->window == nullptr) return none();
  glfwMakeContextCurrent(parts->window);
  glfwSwapInterval(1);
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // leaves no file in the user's folder
  ImGui::StyleColorsDark();
  if (!ImGui_ImplGlfw_InitForOpenGL(parts->window, true) || !ImGui_ImplOpenGL3_Init("#version 150")) return none();
  glGenTextures(1, &parts->texture);
  return ViewWindow(std::move(parts));
}

bool ViewWindow::closing() const {
  return glfwWindowShouldClose(parts_->window) != 0;
}

int ViewWindow::width() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(parts_->window, &width, &height);
  return std::max(width, 1);
}

int ViewWindow::height() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(parts_->window, &width, &height);
  return std::max(height, 1);
}

ViewInput ViewWindow::begin_frame() {
  glfwPollEvents();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  const ImGuiIO& io = ImGui::GetIO();
  ViewInput input;
  if (!io.WantCaptureMouse) {
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Left)) {
      input.turn_px = io.MouseDelta.x;
      input.tilt_px = io.MouseDelta.y;
    }
    input.zoom = io.MouseWheel;
  }
  if (!io.WantCaptureKeyboard) {
    input.pause = ImGui::IsKeyPressed(GLFW_KEY_SPACE, false);
    input.step = ImGui::IsKeyPressed(GLFW_KEY_PERIOD);
  }
  return input;
}

void ViewWindow::end_frame(const Image& picture, Image* shot) {
  Parts& parts = *parts_;
  glfwMakeContextCurrent(parts.window);
  glBindTexture(GL_TEXTURE_2D, parts.texture);
  if (picture.width != parts.texture_width || picture.height != parts.texture_height) {
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.width, picture.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 picture.rgba.data());
    parts.texture_width = picture.width;
    parts.texture_height = picture.height;
  } else {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, picture.width, picture.height, GL_RGBA, GL_UNSIGNED_BYTE,
                    picture.rgba.data());
  }
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const std::uintptr_t texture = parts.texture;
  // NOLINTNEXTLINE(performance-no-int-to-ptr): as ImGui takes it
  ImGui::GetBackgroundDrawList()->AddImage(reinterpret_cast<ImTextureID>(texture), {0, 0}, all);
  ImGui::Render();
  const int w = width(), h = height();
  glViewport(0, 0, w, h);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (shot != nullptr) {
    std::vector<std::uint8_t> rows(4 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
    glReadPixels(0, 0, w, h, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
    *shot = {w, h, std::vector<std::uint8_t>(rows.size())};
    const std::size_t row = 4 * static_cast<std::size_t>(w);
    for (std::size_t y = 0; y < static_cast<std::size_t>(h); ++y) {
      std::memcpy(&shot->rgba[y * row], &rows[(static_cast<std::size_t>(h) - 1 - y) * row], row);
    }
    for (std::size_t i = 3; i < shot->rgba.size(); i += 4) shot->rgba[i] = 255;
  }
  glfwSwapBuffers(parts.window);
}

}  // namespace mobil
