# Headers of others that many units include and that take long to parse, precompiled. Not json.hpp: what including it
# instantiates is instantiated in every unit all the same, which takes longer than parsing it where it is needed.
option(CLPV_PRECOMPILE "Precompile the headers that most units share" ON)

function(clpv_precompile target)
  if(CLPV_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE
      <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <optional> <set> <string>
      <string_view> <tuple> <utility> <vector>
      <CL/opencl.hpp> <fmt/format.h> <glm/glm.hpp> <nlohmann/json_fwd.hpp> ${ARGN})
  endif()
endfunction()
