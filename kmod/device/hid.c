// SPDX-License-Identifier: GPL-2.0-only
/*
 * hid.c - the link to arms that are USB HID devices: a HID driver, and a thread that sends.
 *
 * CONTEXTS
 *   raw_event   as the bus driver likes it: a softirq, a threaded interrupt, a writer of /dev/uhid.
 *               Not sleeping; the HID core never runs two at a time for one device
 *   kick        servo thread: one wake-up, no wait
 *   output      a SCHED_FIFO thread below the servo. Sending waits for the bus, for a millisecond on
 *               USB, up to seconds on a device that does not answer; only this thread waits
 *   start, stop, calibrate    control mutex; wait for the output thread, not for ever
 *
 * LIFE. probe() makes the link, the arm and its unit. remove() comes with the cable still in (rmmod,
 * unbind) or not: the arm is gone at once for the servo, the node goes, the output thread sends zero
 * as its last act and ends; only then is the HID device closed. The memory is freed with the unit.
 *
 * The id 16c0:0486 is that of every Teensy with raw HID, not of this arm alone. So there is no
 * MODULE_DEVICE_TABLE, and the driver is there only when somebody said device=hid.
 */
#include <phantom_platform.h>
#include "device/arm.h"
#include "phantom_kernel.h"

#define PHANTOM_HID_VENDOR 0x16c0 /* Van Ooijen Technische Informatica, for PJRC */
#define PHANTOM_HID_PRODUCT 0x0486 /* Teensy, raw HID */

/* The raw interface's application; the same device has another one, a serial line, on 0xffc9. */
#define PHANTOM_HID_USAGE 0xffab0200

/* Below the servo (80), above threaded interrupt handlers (50). */
#define PHANTOM_HID_PRIORITY 70

/* How long start and stop wait for the bus: the slowest healthy one answers within a few ms. */
#define PHANTOM_HID_PATIENCE_MS 250

/* Reports that may have been under way when the wait for new ones began. */
#define PHANTOM_HID_STALE_REPORTS 1

struct phantom_hid {
	struct phantom_arm arm;
	struct hid_device *hid; /* until remove() */
	struct phantom_unit *unit;
	struct task_struct *output;
	u8 *buffer; /* report number and a whole report; the output thread's. Its own memory: DMA */
	size_t buffer_size;
	u32 asked; /* word, control: flushes asked for */
	u32 answered; /* word, output thread: `asked` before its last sending */
	u32 reports; /* word, raw_event: received */
};

static u32 phantom_hid_max_force_un; /* of every arm; fixed */

static struct phantom_hid *phantom_hid_of(struct phantom_arm *arm)
{
	return container_of(arm, struct phantom_hid, arm);
}

/* ---- sending ------------------------------------------------------------- */

/* Output thread. The buffer holds the command behind its report number. */
static int phantom_hid_transmit(struct phantom_hid *link)
{
	int sent = hid_hw_output_report(link->hid, link->buffer, link->buffer_size);

	/* no interrupt endpoint for output: by the control endpoint */
	if (sent == -ENOSYS)
		sent = hid_hw_raw_request(link->hid, 0, link->buffer, link->buffer_size,
					  HID_OUTPUT_REPORT, HID_REQ_SET_REPORT);
	return sent < 0 ? sent : 0;
}

static bool phantom_hid_has_work(struct phantom_hid *link)
{
	/* pairs with phantom_hid_flush(): the command it waits for is there */
	u32 asked = smp_load_acquire(&link->asked);

	return asked != link->answered || phantom_arm_has_command(&link->arm);
}

static int phantom_hid_output(void *argument)
{
	struct phantom_hid *link = argument;
	u32 asked;

	for (;;) {
		set_current_state(TASK_INTERRUPTIBLE);
		if (kthread_should_stop())
			break;
		if (!phantom_hid_has_work(link)) {
			schedule();
			continue;
		}
		__set_current_state(TASK_RUNNING);
		/* a flush asked for from here on may be for a newer command */
		asked = smp_load_acquire(&link->asked);
		phantom_arm_command(&link->arm, link->buffer + 1);
		phantom_arm_sent(&link->arm, phantom_hid_transmit(link));
		smp_store_release(&link->answered, asked); /* after what was sent */
	}
	__set_current_state(TASK_RUNNING);
	phantom_arm_command_off(link->buffer + 1);
	phantom_hid_transmit(link);
	return 0;
}

static void phantom_hid_kick(struct phantom_arm *arm)
{
	wake_up_process(phantom_hid_of(arm)->output);
}

/* ---- waiting: control ---------------------------------------------------- */

static u64 phantom_hid_now(struct phantom_arm *arm)
{
	return ktime_get_ns();
}

static int phantom_hid_flush(struct phantom_arm *arm)
{
	struct phantom_hid *link = phantom_hid_of(arm);
	u32 mine = link->asked + 1;
	int ms;

	smp_store_release(&link->asked, mine); /* after the command */
	for (ms = 0; ms < PHANTOM_HID_PATIENCE_MS; ms++) {
		if (READ_ONCE(arm->gone))
			return -ENODEV;
		wake_up_process(link->output);
		/* pairs with phantom_hid_output(): its error is there */
		if (smp_load_acquire(&link->answered) == mine)
			return READ_ONCE(arm->error);
		usleep_range(500, 1000);
	}
	return -ETIMEDOUT;
}

static int phantom_hid_listen(struct phantom_arm *arm)
{
	struct phantom_hid *link = phantom_hid_of(arm);
	u32 before = READ_ONCE(link->reports);
	int ms;

	for (ms = 0; ms < PHANTOM_HID_PATIENCE_MS; ms++) {
		if (READ_ONCE(arm->gone))
			return -ENODEV;
		if (READ_ONCE(link->reports) - before > PHANTOM_HID_STALE_REPORTS)
			return 0;
		usleep_range(500, 1000);
	}
	return -ETIMEDOUT;
}

static void phantom_hid_destroy(struct phantom_arm *arm)
{
	struct phantom_hid *link = phantom_hid_of(arm);

	if (link->output)
		put_task_struct(link->output);
	kfree(link->buffer);
	kfree(link);
}

static const struct phantom_arm_link_ops phantom_hid_link_ops = {
	.now_ns = phantom_hid_now,
	.kick = phantom_hid_kick,
	.flush = phantom_hid_flush,
	.listen = phantom_hid_listen,
	.destroy = phantom_hid_destroy,
};

/* ---- the driver ---------------------------------------------------------- */

static int phantom_hid_raw_event(struct hid_device *hid, struct hid_report *report, u8 *data,
				 int size)
{
	struct phantom_hid *link = hid_get_drvdata(hid);

	if (report->type == HID_INPUT_REPORT && !phantom_arm_receive(&link->arm, data, size))
		WRITE_ONCE(link->reports, link->reports + 1);
	return 0;
}

/* Bytes of the only report of that type, 0 when there are none or several. */
static u32 phantom_hid_report_bytes(struct hid_device *hid, unsigned int type)
{
	const struct hid_report_enum *reports = &hid->report_enum[type];

	if (reports->numbered || !reports->report_id_hash[0])
		return 0;
	return (reports->report_id_hash[0]->size + 7) / 8;
}

static struct phantom_hid *phantom_hid_create(struct hid_device *hid)
{
	u32 in = phantom_hid_report_bytes(hid, HID_INPUT_REPORT);
	u32 out = phantom_hid_report_bytes(hid, HID_OUTPUT_REPORT);
	struct phantom_hid *link;

	if (!hid->maxcollection || hid->collection[0].usage != PHANTOM_HID_USAGE ||
	    in < PHANTOM_ARM_REPORT_BYTES || out < PHANTOM_ARM_COMMAND_BYTES) {
		hid_info(hid, "not an arm: its reports are of %u bytes in, %u out\n", in, out);
		return ERR_PTR(-ENODEV);
	}
	link = kzalloc(sizeof(*link), GFP_KERNEL);
	if (!link)
		return ERR_PTR(-ENOMEM);
	link->buffer_size = 1 + out;
	link->buffer = kzalloc(link->buffer_size, GFP_KERNEL);
	if (!link->buffer) {
		kfree(link);
		return ERR_PTR(-ENOMEM);
	}
	link->hid = hid;
	phantom_arm_init(&link->arm, &phantom_arm_woodenhaptics, &phantom_hid_link_ops,
			 phantom_hid_max_force_un);
	return link;
}

static int phantom_hid_start_output(struct phantom_hid *link)
{
	struct sched_attr attributes = {
		.size = sizeof(attributes),
		.sched_policy = SCHED_FIFO,
		.sched_priority = PHANTOM_HID_PRIORITY,
	};
	struct task_struct *output = kthread_create(phantom_hid_output, link, "phantom-output");
	int error;

	if (IS_ERR(output))
		return PTR_ERR(output);
	error = sched_setattr_nocheck(output, &attributes);
	if (error) {
		kthread_stop(output);
		return error;
	}
	/* until the link is freed: a kick may come late */
	link->output = get_task_struct(output);
	wake_up_process(output);
	return 0;
}

/* Reports come and commands go from here on, and until phantom_hid_disconnect(). */
static int phantom_hid_connect(struct phantom_hid *link)
{
	/* no hidraw beside us: nobody else shall send currents */
	int error = hid_hw_start(link->hid, HID_CONNECT_DRIVER);

	if (error)
		return error;
	error = hid_hw_open(link->hid);
	if (error)
		goto no_open;
	error = phantom_hid_start_output(link);
	if (error)
		goto no_output;
	/* the arm would else be silent until probe() has returned */
	hid_device_io_start(link->hid);
	return 0;

no_output:
	hid_hw_close(link->hid);
no_open:
	hid_hw_stop(link->hid);
	return error;
}

static void phantom_hid_disconnect(struct phantom_hid *link)
{
	kthread_stop(link->output);
	hid_hw_close(link->hid);
	hid_hw_stop(link->hid);
}

static int phantom_hid_probe(struct hid_device *hid, const struct hid_device_id *id)
{
	struct phantom_hid *link;
	struct phantom_unit *unit;
	int error = hid_parse(hid);

	if (error)
		return error;
	link = phantom_hid_create(hid);
	if (IS_ERR(link))
		return PTR_ERR(link);
	hid_set_drvdata(hid, link);
	error = phantom_hid_connect(link);
	if (error)
		goto no_connection;
	error = link->arm.device.ops->calibrate(&link->arm.device);
	if (error)
		goto no_unit;
	unit = phantom_unit_create(&link->arm.device, &hid->dev);
	error = PTR_ERR_OR_ZERO(unit);
	if (error)
		goto no_unit;
	error = phantom_unit_add(unit);
	if (error)
		goto no_node;
	link->unit = unit;
	return 0;

no_node:
	phantom_hid_disconnect(link);
	phantom_unit_put(unit); /* and link with it */
	goto failed;
no_unit:
	phantom_hid_disconnect(link);
no_connection:
	phantom_hid_destroy(&link->arm);
failed:
	hid_err(hid, "%s: cannot be used, error %d; plug it in again or load the module anew\n",
		phantom_arm_woodenhaptics.title, error);
	return error;
}

static void phantom_hid_remove(struct hid_device *hid)
{
	struct phantom_hid *link = hid_get_drvdata(hid);
	struct phantom_unit *unit = link->unit;

	phantom_arm_unplug(&link->arm);
	phantom_unit_remove(unit);
	phantom_hid_disconnect(link);
	/* the servo may still look at the arm; the last file's close frees it */
	phantom_unit_put(unit);
}

static const struct hid_device_id phantom_hid_ids[] = {
	{HID_USB_DEVICE(PHANTOM_HID_VENDOR, PHANTOM_HID_PRODUCT)}, {}};

static struct hid_driver phantom_hid_driver = {
	.name = "phantom_rt",
	.id_table = phantom_hid_ids,
	.probe = phantom_hid_probe,
	.remove = phantom_hid_remove,
	.raw_event = phantom_hid_raw_event,
};

int phantom_hid_setup(u32 max_force_un)
{
	phantom_hid_max_force_un = max_force_un;
	pr_info("waiting for arms: %s, USB %04x:%04x; plug it in while it rests in its rest pose\n",
		phantom_arm_woodenhaptics.title, PHANTOM_HID_VENDOR, PHANTOM_HID_PRODUCT);
	return hid_register_driver(&phantom_hid_driver);
}

void phantom_hid_cleanup(void)
{
	hid_unregister_driver(&phantom_hid_driver);
}
