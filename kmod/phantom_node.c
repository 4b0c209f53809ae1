// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_node.c - /dev/phantom_rtN: file operations around phantom_chardev.c.
 */
#include <phantom_platform.h>
#include "phantom_kernel.h"

/* While a file is open its cdev, and so the unit, is held by the VFS. */
static int phantom_node_open(struct inode *inode, struct file *filp)
{
	struct phantom_unit *unit = container_of(inode->i_cdev, struct phantom_unit, cdev);
	struct phantom_file *file =
		phantom_chardev_open(&unit->chardev, filp->f_mode & FMODE_WRITE);

	if (IS_ERR(file))
		return PTR_ERR(file);
	filp->private_data = file;
	return stream_open(inode, filp);
}

static int phantom_node_release(struct inode *inode, struct file *filp)
{
	phantom_chardev_release(filp->private_data);
	return 0;
}

static long phantom_node_ioctl(struct file *filp, unsigned int command, unsigned long argument)
{
	return phantom_chardev_ioctl(filp->private_data, command, (void __user *)argument);
}

static ssize_t phantom_node_read(struct file *filp, char __user *buffer, size_t size,
				 loff_t *position)
{
	return phantom_chardev_read(filp->private_data, buffer, size, filp->f_flags & O_NONBLOCK);
}

static __poll_t phantom_node_poll(struct file *filp, struct poll_table_struct *table)
{
	struct phantom_file *file = filp->private_data;

	poll_wait(filp, &file->chardev->servo->wait, table);
	return phantom_chardev_poll(file);
}

static int phantom_node_mmap(struct file *filp, struct vm_area_struct *vma)
{
	struct phantom_file *file = filp->private_data;
	int error = phantom_chardev_check_mmap(file, vma->vm_flags & (VM_WRITE | VM_EXEC),
					       (u64)vma->vm_pgoff << PAGE_SHIFT,
					       vma->vm_end - vma->vm_start);

	if (error)
		return error;
	/* no mprotect() later either */
	vm_flags_clear(vma, VM_MAYWRITE | VM_MAYEXEC);
	return remap_vmalloc_range(vma, file->chardev->servo->stats.page, 0);
}

const struct file_operations phantom_node_operations = {
	.owner = THIS_MODULE,
	.open = phantom_node_open,
	.release = phantom_node_release,
	.unlocked_ioctl = phantom_node_ioctl,
	.compat_ioctl = compat_ptr_ioctl,
	.read = phantom_node_read,
	.poll = phantom_node_poll,
	.mmap = phantom_node_mmap,
};
