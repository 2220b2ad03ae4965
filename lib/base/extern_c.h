/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every public header stands between these two, so that C++ programs find its functions.
 */
#ifndef TM_BASE_EXTERN_C_H
#define TM_BASE_EXTERN_C_H

#ifdef __cplusplus
#define TM_EXTERN_C_BEGIN extern "C" {
#define TM_EXTERN_C_END   }
#else
#define TM_EXTERN_C_BEGIN
#define TM_EXTERN_C_END
#endif

#endif
