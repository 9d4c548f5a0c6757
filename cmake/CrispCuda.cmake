# SPDX-License-Identifier: BSD-3-Clause
# CRISP_CUDA is on if the CUDA plugin is built: when it is requested and nvcc is found.
option(CRISP_BUILD_CUDA "Build the plugin that measures on a graphics processor, if nvcc is found" OFF)
set(CRISP_CUDA OFF)
if(CRISP_BUILD_CUDA)
  include(CheckLanguage)
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
      set(CMAKE_CUDA_ARCHITECTURES all-major)
    endif()
    enable_language(CUDA)
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)  # CMake 3.25 does not know that nvcc speaks C++20
      set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
      set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
    endif()
    find_package(CUDAToolkit REQUIRED)
    set(CRISP_CUDA ON)
  else()
    message(WARNING "CRISP_BUILD_CUDA is on, but nvcc was not found: the CUDA plugin is not built. "
                    "Put nvcc into PATH, or name it by -DCMAKE_CUDA_COMPILER=...")
  endif()
endif()
