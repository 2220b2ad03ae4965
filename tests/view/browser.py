# SPDX-License-Identifier: GPL-3.0-or-later
"""A headless Chromium that shows a page, driven over its debugging protocol by a pipe:
what the tests of mesh-view, the pictures of README and the benchmark use.

    browser.py PAGE.html [--size W,H] [--dark] [--hash HASH] [--picture FILE.png]

prints what the page says of itself, and fails where it has an error or asks the network."""
import argparse
import base64
import fcntl
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

PROGRAM = shutil.which('chromium')
SECONDS = 120


def move_up(fd):
    """The same file under a number that is neither 3 nor 4."""
    moved = fcntl.fcntl(fd, fcntl.F_DUPFD, 10)
    os.close(fd)
    return moved


class Browser:
    """One page. Errors of it, and what it asked the network for, are lists."""

    def __init__(self, size=(1200, 800), dark=False):
        self.errors, self.requests, self.number = [], [], 0
        self.waiting = b''
        self.folder = tempfile.mkdtemp(prefix='mesh-view-')
        there, self.out = os.pipe()
        self.back, here = os.pipe()
        there, here = (move_up(fd) for fd in (there, here))
        # The program reads from 3 and writes to 4.
        command = [PROGRAM, '--headless=new', '--no-sandbox', '--disable-dev-shm-usage',
                   '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
                   '--remote-debugging-pipe', '--no-first-run', '--disable-extensions',
                   '--disable-background-networking', '--hide-scrollbars',
                   f'--user-data-dir={self.folder}', 'about:blank']
        shell = 'exec 3<&%d 4>&%d; exec "$@"' % (there, here)
        self.process = subprocess.Popen(['bash', '-c', shell, 'bash', *command],
                                        pass_fds=(there, here), stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(there)
        os.close(here)
        self.session = None
        target = self.call('Target.createTarget', url='about:blank')['targetId']
        self.session = self.call('Target.attachToTarget', targetId=target,
                                 flatten=True)['sessionId']
        for domain in ('Page', 'Runtime', 'Log', 'Network'):
            self.call(domain + '.enable')
        self.resize(size)
        self.theme(dark)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.out)
        os.close(self.back)
        try:
            self.process.wait(5)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def read(self):
        """The next message."""
        while b'\0' not in self.waiting:
            more = os.read(self.back, 1 << 20)
            if not more:
                raise RuntimeError('the browser has gone')
            self.waiting += more
        message, self.waiting = self.waiting.split(b'\0', 1)
        return json.loads(message)

    def call(self, method, **parameters):
        self.number += 1
        message = {'id': self.number, 'method': method, 'params': parameters}
        if self.session:
            message['sessionId'] = self.session
        bytes_left = json.dumps(message).encode() + b'\0'
        while bytes_left:
            bytes_left = bytes_left[os.write(self.out, bytes_left):]
        while True:
            answer = self.read()
            if answer.get('id') == self.number:
                if 'error' in answer:
                    raise RuntimeError(f'{method}: {answer["error"]["message"]}')
                return answer['result']
            self.notice(answer)

    def notice(self, event):
        what, of = event.get('method'), event.get('params', {})
        if what == 'Runtime.exceptionThrown':
            details = of['exceptionDetails']
            self.errors.append(details.get('exception', {}).get('description', details['text']))
        elif what == 'Runtime.consoleAPICalled' and of['type'] in ('error', 'warning', 'assert'):
            self.errors.append(' '.join(str(a.get('value', a)) for a in of['args']))
        elif what == 'Log.entryAdded' and of['entry']['level'] == 'error':
            self.errors.append(of['entry']['text'])
        elif what == 'Network.requestWillBeSent':
            if not of['request']['url'].startswith(('file:', 'about:', 'blob:', 'data:')):
                self.requests.append(of['request']['url'])

    def resize(self, size):
        self.call('Emulation.setDeviceMetricsOverride', width=size[0], height=size[1],
                  deviceScaleFactor=1, mobile=False)

    def theme(self, dark):
        self.call('Emulation.setEmulatedMedia', features=[
            {'name': 'prefers-color-scheme', 'value': 'dark' if dark else 'light'}])

    def open(self, file, fragment=''):
        """Opens a file, and waits until it shows its mesh, or says that it cannot. Seconds
        from the beginning."""
        begin = time.monotonic()
        self.call('Page.navigate', url='file://' + os.path.abspath(file) + fragment)
        self.run('meshView.ready.then(() => 1, () => 0)', until=begin + SECONDS)
        return time.monotonic() - begin

    def run(self, expression, until=None):
        """The value of an expression in the page. until: again and again up to then."""
        while True:
            answer = self.call('Runtime.evaluate', expression=expression, awaitPromise=True,
                               returnByValue=True)
            if 'exceptionDetails' not in answer:
                return answer['result'].get('value')
            if not until or time.monotonic() > until:
                details = answer['exceptionDetails']
                raise RuntimeError(details.get('exception', {}).get('description', str(details)))
            time.sleep(0.02)

    def mouse(self, kind, x, y, **more):
        self.call('Input.dispatchMouseEvent', type=kind, x=x, y=y, **more)

    def click(self, x, y):
        for kind in ('mousePressed', 'mouseReleased'):
            self.mouse(kind, x, y, button='left', clickCount=1,
                       buttons=1 if kind == 'mousePressed' else 0)

    def drag(self, points, modifiers=0):
        self.mouse('mousePressed', *points[0], button='left', clickCount=1, buttons=1)
        for x, y in points[1:]:
            self.mouse('mouseMoved', x, y, button='left', buttons=1, modifiers=modifiers)
        self.mouse('mouseReleased', *points[-1], button='left', clickCount=1)

    def key(self, key, modifiers=0):
        for kind in ('keyDown', 'keyUp'):
            self.call('Input.dispatchKeyEvent', type=kind, key=key, modifiers=modifiers,
                      **({'text': key} if kind == 'keyDown' and len(key) == 1 else {}))

    def picture(self, file):
        self.run('new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))')
        data = self.call('Page.captureScreenshot', format='png')['data']
        with open(file, 'wb') as to:
            to.write(base64.b64decode(data))


def main():
    options = argparse.ArgumentParser()
    options.add_argument('page')
    options.add_argument('--size', default='1200,800')
    options.add_argument('--dark', action='store_true')
    options.add_argument('--hash', default='')
    options.add_argument('--picture')
    options.add_argument('--run', action='append', default=[])
    given = options.parse_args()
    if not PROGRAM:
        sys.exit('there is no chromium')
    size = tuple(int(n) for n in given.size.split(','))
    with Browser(size, given.dark) as browser:
        print('seconds', round(browser.open(given.page, given.hash), 2))
        for expression in given.run:
            print(json.dumps(browser.run(expression)))
        print(browser.run('document.getElementById("counts").textContent'),
              browser.run('document.getElementById("message").textContent'))
        if given.picture:
            browser.picture(given.picture)
        for error in browser.errors + browser.requests:
            print(error, file=sys.stderr)
        sys.exit(1 if browser.errors or browser.requests else 0)


if __name__ == '__main__':
    main()
