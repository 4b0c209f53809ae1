// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/picture_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <unistd.h>

#include <fmt/format.h>
#include <vtkImageShrink3D.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

namespace phantom::view {

Status save_window(vtkRenderWindow* window, const std::filesystem::path& file, int shrink)
{
    vtkNew<vtkWindowToImageFilter> pixels;
    pixels->SetInput(window);
    pixels->SetInputBufferTypeToRGB();
    pixels->ReadFrontBufferOff();
    vtkNew<vtkImageShrink3D> smaller;
    smaller->SetInputConnection(pixels->GetOutputPort());
    smaller->SetShrinkFactors(shrink, shrink, 1);
    smaller->MeanOn();
    vtkNew<vtkPNGWriter> png;
    png->SetInputConnection(smaller->GetOutputPort());
    png->WriteToMemoryOn();
    png->Write();
    vtkUnsignedCharArray* bytes = png->GetResult();
    if (bytes == nullptr || bytes->GetNumberOfValues() == 0)
        return Error{file.string(), "the picture could not be drawn"};

    std::filesystem::path part = file;
    part += fmt::format(".{}.part", getpid());
    std::ofstream out(part, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes->GetPointer(0)),
              static_cast<std::streamsize>(bytes->GetNumberOfValues()));
    out.close();
    std::error_code error;
    if (out)
        std::filesystem::rename(part, file, error);
    else
        error = std::error_code(errno, std::generic_category());
    if (!error)
        return success();
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    return Error{file.string(), "the picture cannot be written: " + error.message()};
}

} // namespace phantom::view
