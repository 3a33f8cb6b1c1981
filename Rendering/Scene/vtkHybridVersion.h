/**
 * @file vtkHybridVersion.h
 * @brief what differs between the VTK releases that this module supports
 *
 * VTK 9.3 introduced the macros that open and close its ABI namespace; for older releases they are
 * defined empty here, so that the classes are written in one way only. Include it after a VTK
 * header.
 */
#ifndef vtkHybridVersion_h
#define vtkHybridVersion_h

#include "vtkObject.h" // brings vtkABINamespace.h where there is one

#ifndef VTK_ABI_NAMESPACE_BEGIN
#define VTK_ABI_NAMESPACE_BEGIN
#define VTK_ABI_NAMESPACE_END
#endif

#endif
