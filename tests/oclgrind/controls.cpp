// Runs the kernels of controls.cl. CLPV_KERNEL_DIR names their folder.
#include "device/session.hpp"

int main() {
  using namespace clpv;
  constexpr std::size_t kItems = 8, kGroup = 4, kBytes = kItems * sizeof(cl_int);
  Session session(choose_device());
  const ProgramSource source{"controls.cl", {}, {}};
  const cl::Buffer written = session.buffer(kBytes, "written"),
                   unwritten = session.buffer(kBytes, "unwritten");
  session.fill_zero(written, kBytes);

  cl::Kernel sound = session.kernel(source, "sound");
  sound.setArg(0, written);
  session.launch(sound, cl::NDRange(kItems), cl::NDRange(kGroup));

  cl::Kernel racy = session.kernel(source, "racy");
  racy.setArg(0, written);
  session.launch(racy, cl::NDRange(kItems), cl::NDRange(kGroup));

  cl::Kernel uninitialised = session.kernel(source, "uninitialised");
  uninitialised.setArg(0, unwritten);
  uninitialised.setArg(1, written);
  session.launch(uninitialised, cl::NDRange(kItems), cl::NDRange(kGroup));
  session.queue().finish();
}
